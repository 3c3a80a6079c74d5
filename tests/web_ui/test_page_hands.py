"""What a hand does to the robot: it picks it up, is before its sensors, tilts it; by pointer, keys and touch."""

from __future__ import annotations

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.web_ui.page_support import MARKS, choose_robot, open_hands, open_menu, open_page, wait_for_position

pytestmark = MARKS

HELD = "(held) => window.thymio.state().robot.latest.pose.z > 0.03 === held"
SEEN = "(counts) => String(window.thymio.state().robot.raw.proximity?.slice(0, 5)) === String(counts)"


@pytest.mark.slow
def test_pick_up_holds_the_robot_until_it_is_put_down(world, page):
    open_page(page, world("base"))
    lift = page.locator("[data-hand=lift]")
    playwright.expect(lift).to_have_text("Pick up")
    lift.click()
    page.wait_for_function(HELD, arg=True)
    playwright.expect(lift).to_have_text("Put down")
    playwright.expect(lift).to_have_attribute("aria-pressed", "true")
    playwright.expect(page.locator("#live")).to_have_text("The robot is in your hand.")
    lift.click()
    page.wait_for_function(HELD, arg=False)
    playwright.expect(lift).to_have_attribute("aria-pressed", "false")


@pytest.mark.slow
def test_all_robots_are_picked_up_together(world, page):
    open_page(page, world("two_robots"))
    page.wait_for_function("() => Object.keys(window.thymio.state().robots).length === 2")
    choose_robot(page, "*")
    page.locator("[data-hand=lift]").click()
    page.wait_for_function(
        "() => Object.values(window.thymio.state().robots).every(({latest}) => latest?.pose.z > 0.03)"
    )


def test_a_hand_before_the_sensors_stays_until_it_is_taken_away(at_rest, page):
    open_page(page, at_rest)
    hand = page.locator("[data-hand=hand]")
    open_hands(page, "hand")
    page.get_by_role("button", name="in front", exact=True).click()
    page.wait_for_function(SEEN, arg=[0, 1509, 3510, 1509, 0])
    playwright.expect(hand).to_have_attribute("data-held", "true")
    page.locator("[data-operate=near]").fill("100")
    page.wait_for_function(SEEN, arg=[0, 1935, 4500, 1935, 0])
    page.get_by_role("button", name="Take the hand away").click()
    page.wait_for_function(SEEN, arg=[0, 0, 0, 0, 0])
    playwright.expect(hand).to_have_attribute("data-held", "false")


@pytest.mark.slow
def test_hands_have_letters_and_escape_closes_sheet_and_move_mode_before_it_stops_the_robot(world, page):
    open_page(page, world("base", behaviour="explorer"))
    page.wait_for_function("() => window.thymio.state().program?.state === 'running'")
    view = page.locator("#view")
    for key, sheet in (("h", "#hand-sheet"), ("i", "#tilt-sheet"), ("p", "#pen-sheet"), ("r", "#remote-sheet")):
        view.focus()
        page.keyboard.press(key)
        playwright.expect(page.locator(sheet)).to_be_visible()
        page.keyboard.press("Escape")
        playwright.expect(page.locator(sheet)).to_be_hidden()
    view.focus()
    page.keyboard.press("l")
    page.wait_for_function(HELD, arg=True)
    page.keyboard.press("l")
    page.wait_for_function(HELD, arg=False)
    beams = page.locator("[data-view=beams]")
    playwright.expect(beams).to_have_attribute("aria-pressed", "true")
    page.keyboard.press("b")
    playwright.expect(beams).to_have_attribute("aria-pressed", "false")
    page.keyboard.press("Space")
    page.wait_for_function("() => window.thymio.state().simulator.paused")
    page.keyboard.press("Space")
    page.wait_for_function("() => !window.thymio.state().simulator.paused")
    move = page.locator("[data-view=move]")
    move.click()
    playwright.expect(move).to_have_attribute("aria-pressed", "true")
    page.locator("#theme").focus()  # away from the view
    page.keyboard.press("Escape")
    playwright.expect(move).to_have_attribute("aria-pressed", "false")
    assert page.evaluate("() => window.thymio.state().program.state") == "running"
    page.keyboard.press("Escape")
    page.wait_for_function("() => window.thymio.state().program.state === 'stopped'")


@pytest.mark.slow
def test_a_folded_tray_opens_for_a_hand_with_values(at_rest, page):
    open_page(page, at_rest)
    page.locator("#tray-fold").click()
    playwright.expect(page.locator("#tray-unfold")).to_be_focused()
    page.locator("#view").focus()
    page.keyboard.press("i")
    playwright.expect(page.locator("#tilt-sheet")).to_be_visible()
    playwright.expect(page.locator("#tray-unfold")).to_be_hidden()
    page.locator("[data-operate=roll]").fill("30")
    playwright.expect(page.locator("[data-hand=tilt]")).to_have_attribute("data-held", "true")
    page.locator("[data-operate=level]").click()
    playwright.expect(page.locator("[data-hand=tilt]")).to_have_attribute("data-held", "false")


@pytest.mark.slow
def test_on_a_phone_every_hand_camera_and_tool_is_in_reach(world, touch_page):
    touch_page.set_viewport_size({"width": 390, "height": 844})
    open_page(touch_page, world("base"))
    wait_for_position(touch_page, "robot")
    open_hands(touch_page, "pen")
    touch_page.locator("[data-pen=down]").tap()
    touch_page.keyboard.press("Escape")
    touch_page.keyboard.press("Escape")
    open_menu(touch_page, "#cameras-open")
    touch_page.locator("[data-view=top]").tap()
    playwright.expect(touch_page.locator("#cameras-open")).to_have_text("Above")
    playwright.expect(touch_page.locator("#camera-list")).to_be_hidden()
    open_menu(touch_page, "#tools-open")
    touch_page.locator("[data-view=move]").tap()
    playwright.expect(touch_page.locator("#tool-list")).to_be_hidden()
    touch_page.wait_for_function("() => window.thymio.dragged() !== null")
    step = touch_page.locator("#time [data-verb=step]")
    playwright.expect(step).to_be_hidden()
    touch_page.locator("#pause").tap()
    playwright.expect(step).to_be_enabled()
    touch_page.wait_for_function("() => document.documentElement.scrollWidth <= innerWidth")
