"""The tour: offered once, closed permanently, reopened by a button, usable by keys, not blocking."""

from __future__ import annotations

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.processes import wait_for_port
from tests.web_ui.page_support import MARKS, choose_language, open_menu
from tests.web_ui.test_page_access import AXE, FINDINGS
from tests.web_ui.test_page_recovery import NO_STORAGE

pytestmark = MARKS

READY = "window.thymio && window.thymio.connected && window.thymio.partPosition('robot')"
IN_SIGHT = """() => {
    const {left, top, right, bottom} = document.querySelector(".tour").getBoundingClientRect();
    return left >= 0 && top >= 0 && right <= innerWidth && bottom <= innerHeight;
}"""
STEPS = 5


@pytest.fixture
def first_visit(world, page):
    """The page at a first visit, and its address."""
    return page, ready(world("base", "explorer"))


def ready(address):
    wait_for_port(int(address.rsplit(":", 1)[1].strip("/")))
    return address


def visit(page, address):
    page.goto(address)
    page.wait_for_function(READY)


def test_it_is_offered_once_works_by_keys_stops_no_robot_and_is_reopened_by_its_button(first_visit):
    page, address = first_visit
    visit(page, address)
    page.get_by_role("button", name="Show me around").press("Enter")
    playwright.expect(page.locator(".welcome-tour")).to_have_count(0)
    tour = page.get_by_role("dialog", name="Your robot’s world")
    playwright.expect(tour).to_contain_text("1 of 5")
    playwright.expect(page.locator(".tour .next")).to_be_focused()
    page.wait_for_function("() => window.thymio.state().program?.state === 'running'")
    for step in range(2, STEPS + 1):
        page.keyboard.press("Enter")
        playwright.expect(page.locator(".tour")).to_contain_text(f"{step} of 5")
        page.wait_for_function(IN_SIGHT)
    playwright.expect(page.locator(".tour .next")).to_have_text("Done")
    page.locator(".tour").get_by_role("button", name="Back").press("Enter")
    playwright.expect(page.locator(".tour")).to_contain_text("4 of 5")
    page.keyboard.press("Escape")
    playwright.expect(page.locator(".tour")).to_have_count(0)
    playwright.expect(page.locator("#help-open")).to_be_focused()
    page.locator("#pause").click()
    page.wait_for_function("window.thymio.state().simulator.paused")  # asked for after a stop would have been
    assert page.evaluate("window.thymio.state().program.state") == "running"
    visit(page, address)
    page.locator(".welcome-starts").wait_for()  # which the tour hid, and which is loaded with the offer
    playwright.expect(page.locator(".tour, .welcome-tour")).to_have_count(0)
    open_menu(page, "#help-open")
    page.click("[data-help=tour]")
    playwright.expect(page.locator(".tour")).to_contain_text("1 of 5")
    choose_language(page, "de")
    playwright.expect(page.locator(".tour")).to_contain_text("Die Welt deines Roboters")


@pytest.mark.slow
def test_an_offer_that_is_declined_does_not_come_back(first_visit):
    page, address = first_visit
    visit(page, f"{address}?welcome=off")
    page.get_by_role("button", name="Not now").click()
    playwright.expect(page.locator(".welcome-tour")).to_have_count(0)
    visit(page, f"{address}?welcome=on")
    page.locator(".welcome-starts").wait_for()
    playwright.expect(page.locator(".tour, .welcome-tour")).to_have_count(0)


@pytest.mark.slow
def test_it_does_not_block_the_page(first_visit):
    page, address = first_visit
    visit(page, f"{address}?tour=on&welcome=off")
    page.evaluate("() => document.querySelector('#tray[data-folded] #tray-unfold')?.click()")
    page.locator(".tour").wait_for()
    page.locator("[data-button=forward]").hover()
    page.mouse.down()
    page.wait_for_function("() => window.thymio.state().robot.buttons.forward")
    page.mouse.up()
    page.locator("#pause").click()
    page.wait_for_function("window.thymio.state().simulator.paused")


@pytest.mark.slow
def test_the_address_disables_or_forces_it(first_visit):
    page, address = first_visit
    visit(page, f"{address}?tour=off")
    page.locator(".welcome-starts").wait_for()
    playwright.expect(page.locator(".tour, .welcome-tour")).to_have_count(0)
    visit(page, f"{address}?tour=on")
    page.locator(".tour-close").click()
    visit(page, f"{address}?tour=on")
    page.locator(".tour").wait_for()


@pytest.mark.slow
def test_it_can_be_closed_without_browser_storage(world, own_page):
    page, address = own_page, ready(world("base", "explorer"))
    page.add_init_script(NO_STORAGE)
    visit(page, address)
    page.click("[data-tour=yes]")
    page.locator(".tour-close").click()
    page.reload()
    page.wait_for_function(READY)
    page.locator(".welcome-starts").wait_for()
    playwright.expect(page.locator(".tour, .welcome-tour")).to_have_count(0)


@pytest.mark.slow
@pytest.mark.parametrize("size", [(1280, 650), (820, 1180), (360, 640)])
def test_it_is_visible_and_accessible_on_every_screen_in_every_language(first_visit, size):
    page, address = first_visit
    page.set_viewport_size({"width": size[0], "height": size[1]})
    page.emulate_media(reduced_motion="reduce")
    visit(page, f"{address}?tour=on")
    page.locator(".tour").wait_for()
    for language in ("de", "fr", "it", "en"):
        choose_language(page, language)
        page.wait_for_function(IN_SIGHT)
    if AXE.exists():
        page.add_script_tag(path=str(AXE))
        assert page.evaluate(FINDINGS) == []
    for _ in range(STEPS - 1):
        page.locator(".tour .next").click()
        page.wait_for_function(IN_SIGHT)
    assert page.evaluate("() => getComputedStyle(document.querySelector('.tour')).transitionDuration") == "0s"
