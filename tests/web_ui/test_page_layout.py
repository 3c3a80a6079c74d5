"""The frame of the page: tabs, widths, themes, menus, and the choice of the robot or of all robots."""

from __future__ import annotations

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.web_ui.page_support import (
    MARKS,
    build_playground,
    choose_example,
    choose_robot,
    open_menu,
    open_page,
    open_tab,
    resize,
    wait_for_frame,
)
from tests.web_ui.test_page_touch import STOP_IN_SIGHT

pytestmark = MARKS

WIDTH = "(width) => Math.round(document.querySelector('#work').getBoundingClientRect().width) === width"
RUNNING = "() => window.thymio.state().program?.state === 'running'"


@pytest.mark.slow
def test_the_open_tab_and_its_width_are_kept_and_stop_is_visible_at_every_size(world, page):
    page.set_viewport_size({"width": 1280, "height": 800})
    open_page(page, world("base", behaviour="explorer"))
    page.wait_for_function(WIDTH, arg=88)
    open_tab(page, "program")
    page.wait_for_function(WIDTH, arg=752)
    open_tab(page, "robot")
    page.wait_for_function(WIDTH, arg=480)
    page.focus("#grip")
    page.keyboard.press("ArrowLeft")
    page.wait_for_function(WIDTH, arg=496)
    page.reload()
    page.wait_for_function("window.thymio && window.thymio.connected")
    playwright.expect(page.locator("#tab-robot")).to_have_attribute("aria-selected", "true")
    page.wait_for_function(WIDTH, arg=496)
    page.dblclick("#grip")
    page.wait_for_function(WIDTH, arg=480)
    for width, height in ((1024, 768), (800, 600), (640, 400), (390, 844), (360, 640)):
        resize(page, width, height)
        for tab in ("robot", "program", "playground"):
            open_tab(page, tab)
            page.wait_for_function(STOP_IN_SIGHT)
            page.wait_for_function("() => document.documentElement.scrollWidth <= innerWidth")
    page.set_viewport_size({"width": 1280, "height": 800})
    page.click("#work-fold")
    playwright.expect(page.locator("#tab-playground")).to_be_focused()
    page.wait_for_function(WIDTH, arg=88)


@pytest.mark.slow
def test_escape_closes_a_menu_first_and_the_theme_is_kept(world, page):
    open_page(page, world("base", behaviour="explorer"))
    page.wait_for_function(RUNNING)
    open_menu(page, "#theme")
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Escape")
    playwright.expect(page.locator("#theme")).to_be_focused()
    open_menu(page, "[data-view=look]")
    page.keyboard.press("Escape")
    playwright.expect(page.locator("#look-sheet")).to_be_hidden()
    open_menu(page, "#theme")
    page.click("[data-theme-choice=dark]")
    playwright.expect(page.locator("html")).to_have_attribute("data-theme", "dark")
    page.reload()
    page.wait_for_function("window.thymio && window.thymio.connected")
    playwright.expect(page.locator("html")).to_have_attribute("data-theme", "dark")
    page.wait_for_function(RUNNING)
    page.locator("#view").focus()
    page.keyboard.press("Escape")
    page.wait_for_function("() => window.thymio.state().program?.state === 'stopped'")


def test_actions_go_to_the_chosen_robot_or_to_all(world, page):
    open_page(page, world("two_robots"))
    page.wait_for_function("() => Object.keys(window.thymio.state().robots).length === 2")
    names = page.evaluate("() => Object.keys(window.thymio.state().robots)")
    pressed = "(names) => names.every((name) => window.thymio.state().robots[name].buttons.left)"
    released = "(names) => names.every((name) => !window.thymio.state().robots[name].buttons.left)"
    choose_robot(page, "*")
    playwright.expect(page.locator("#stop")).to_have_text("Stop all 2")
    page.locator("[data-button=left]").hover()
    page.mouse.down()
    page.wait_for_function(pressed, arg=names)
    page.mouse.up()
    page.wait_for_function(released, arg=names)
    runs = "([name, behavior]) => window.thymio.state().programs[name]?.name.startsWith(behavior)"
    choose_example(page, "explorer")
    for name in names:
        page.wait_for_function(runs, arg=[name, "explorer"])
    choose_robot(page, names[1])
    playwright.expect(page.locator("#stop")).to_have_text(f"Stop {names[1]}")
    choose_example(page, "friendly")
    page.wait_for_function(runs, arg=[names[1], "friendly"])
    page.click("#stop")
    page.wait_for_function("(name) => window.thymio.state().programs[name].state === 'stopped'", arg=names[1])
    assert page.evaluate("(name) => window.thymio.state().programs[name].state", names[0]) == "running"
    assert page.evaluate(runs, [names[0], "explorer"])


@pytest.mark.slow
def test_the_creator_continues_when_its_tab_is_opened_again(at_rest, page):
    open_page(page, at_rest)
    build_playground(page)
    playwright.expect(page.locator("#time")).to_be_hidden()
    open_tab(page, "robot")
    playwright.expect(page.locator("#time")).to_be_visible()
    assert page.evaluate("() => window.thymio.built().isOpen") is False
    open_tab(page, "playground")
    page.locator(".palette").wait_for()
    page.click(".creator .leave")
    playwright.expect(page.locator("#playground-change")).to_be_visible()


@pytest.mark.slow
def test_the_names_of_views_follow_the_height_of_the_window_alone(at_rest, page):
    page.set_viewport_size({"width": 1280, "height": 640})
    open_page(page, at_rest, unfold=False)
    row = page.locator(".view-row")
    playwright.expect(row).to_have_attribute("data-names", "beside")
    page.set_viewport_size({"width": 1280, "height": 460})
    playwright.expect(row).to_have_attribute("data-names", "few")
    page.set_viewport_size({"width": 1280, "height": 640})
    playwright.expect(row).to_have_attribute("data-names", "beside")


@pytest.mark.slow
def test_the_program_tab_begins_with_its_buttons_in_a_low_window(at_rest, page):
    page.set_viewport_size({"width": 683, "height": 384})
    for _visit in range(2):  # at the second one, the files of the tab are in the browser's memory
        open_page(page, at_rest, unfold=False)
        open_tab(page, "program")
        page.locator(".program-start .program-card").first.wait_for()
        wait_for_frame(page)
        assert page.locator("#panel-program").evaluate("(panel) => panel.scrollTop") == 0
