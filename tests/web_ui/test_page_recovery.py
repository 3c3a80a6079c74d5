"""Recovery after a lost connection or a restart, and several browsers at once."""

from __future__ import annotations

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.processes import free_port, wait_for_port
from tests.web_ui.page_support import (
    MARKS,
    build_playground,
    choose_language,
    choose_playground,
    open_editor,
    open_page,
    open_tab,
    wait_for_frame,
    wait_for_service,
)

pytestmark = MARKS

PAUSED = "() => window.thymio.state().simulator?.paused === true"


@pytest.mark.slow
def test_the_page_reconnects_to_a_restarted_simulator_and_discards_old_state(suite, page):
    ports = (free_port(), free_port())
    open_page(page, suite("--playground", "two_robots", "--program", "none", ports=ports))
    page.wait_for_function("() => Object.keys(window.thymio.state().robots).length === 2")
    suite.end()
    page.wait_for_function("() => !window.thymio.connected")
    banner = page.locator(".banner:not([hidden])")
    playwright.expect(banner).to_contain_text("tries again every second")
    suite("--playground", "base", "--program", "none", ports=ports)
    wait_for_port(ports[1])
    page.wait_for_function("() => window.thymio.connected")
    page.wait_for_function("() => window.thymio.state().simulator?.playground === 'base'")
    page.wait_for_function("() => Object.keys(window.thymio.state().robots).length === 1")
    page.wait_for_function("() => Boolean(window.thymio.state().robot?.latest)")
    playwright.expect(banner).to_have_count(0)
    playwright.expect(page.locator("#connection")).to_have_attribute("data-state", "connected")


LOCKED = {
    "program": ".pad button, .program-head > [data-verb], #time button, #time select, .stop",
    "playground": ".sample, #playground-change",
}
STIMULI = ".hand:not(.quiet), .hand-sheet input, .hand-sheet button"
STATES = """(controls) => [...document.querySelectorAll(controls)]
    .map((one) => [one.matches(":disabled"), one.title || one.closest("fieldset")?.title || ""])"""


@pytest.mark.slow
def test_controls_are_disabled_with_a_reason_while_the_simulator_is_gone(suite, page):
    ports = (free_port(), free_port())
    arguments = ("--playground", "base", "--behaviour", "menu")
    open_page(page, suite(*arguments, ports=ports))
    page.wait_for_function("window.thymio.state().program?.state === 'running'")
    open_editor(page)
    suite.end()
    page.wait_for_function("() => !window.thymio.connected")
    load = page.locator("[data-verb=load]")
    playwright.expect(load).to_be_disabled()
    page.focus(".cm-content")
    page.keyboard.press("Control+End")
    page.keyboard.insert_text("# kept")
    states = page.evaluate(STATES, STIMULI)
    for tab, controls in LOCKED.items():
        open_tab(page, tab)
        wait_for_frame(page)
        states += page.evaluate(STATES, controls)
        assert {title for _, title in page.evaluate(STATES, controls)} == {"Not connected to the simulator"}
    assert len(states) > 30
    assert all(disabled for disabled, _ in states)
    suite(*arguments, ports=ports)
    wait_for_port(ports[1])
    page.wait_for_function("window.thymio.connected && window.thymio.state().program?.state === 'running'")
    playwright.expect(page.locator("#pause")).to_be_enabled()
    page.locator("#pause").click()
    page.wait_for_function(PAUSED)
    playwright.expect(page.locator(".pad button").first).to_be_enabled()
    playwright.expect(page.locator(".pad button").first).to_have_attribute("title", "Forward")
    assert not any(disabled for disabled, _ in page.evaluate(STATES, STIMULI))
    for tab, controls in reversed(LOCKED.items()):
        open_tab(page, tab)
        wait_for_frame(page)
        assert not any(disabled for disabled, _ in page.evaluate(STATES, controls))
    playwright.expect(page.locator(".cm-content")).to_contain_text("# kept")


NO_STORAGE = """Object.defineProperty(window, "localStorage", {
    get() { throw new DOMException("The browser keeps nothing.", "SecurityError"); }
})"""


def test_the_page_works_without_browser_storage(at_rest, own_page):
    page = own_page
    page.add_init_script(NO_STORAGE)
    open_page(page, at_rest)
    choose_language(page, "fr")
    playwright.expect(page.locator(".stop")).to_contain_text("Arrêt")
    open_editor(page)
    page.focus(".cm-content")
    page.keyboard.insert_text("var a")
    build_playground(page)
    page.locator("#creator-try").wait_for()
    open_editor(page)
    playwright.expect(page.locator(".cm-content")).to_contain_text("var a")


@pytest.mark.slow
def test_the_editor_shows_errors_after_a_restart_and_a_failed_load_is_reported(suite, page):
    ports = (free_port(), free_port())
    open_page(page, suite("--playground", "base", "--program", "none", ports=ports))
    wait_for_service(page, "/aseba_runtime/check")
    open_editor(page)
    verdict = page.locator(".verdict")
    playwright.expect(verdict).to_contain_text("No mistakes")
    suite.end()
    page.wait_for_function("() => !window.thymio.connected")
    page.focus(".cm-content")
    page.keyboard.insert_text("var a = b")
    playwright.expect(verdict).to_contain_text("as soon as the robot is connected")
    open_tab(page, "playground")
    page.click(".current [data-new]")
    playwright.expect(page.locator(".notice")).to_contain_text("Reload the page")
    suite("--playground", "base", "--program", "none", ports=ports)
    open_tab(page, "program")
    playwright.expect(verdict).to_have_text("1 mistake, line 1")
    playwright.expect(page.locator(".mistake-card")).to_contain_text("No variable is called 'b'")


@pytest.mark.slow
def test_actions_in_one_browser_are_visible_in_one_that_connects_late(world, page, other_page):
    address = world("base")
    open_page(page, address)
    page.locator("#view").focus()
    page.locator("#pause").click()
    page.wait_for_function(PAUSED)
    open_page(other_page, address)
    other_page.wait_for_function(PAUSED)
    other_page.wait_for_function("() => window.thymio.state().markers > 0 && window.thymio.state().program !== null")
    other_page.wait_for_function("() => window.thymio.state().playgrounds.length > 3")
    other_page.locator("#pause").click()
    page.wait_for_function("() => window.thymio.state().simulator.paused === false")
    choose_playground(other_page, "obstacle")
    page.wait_for_function("() => window.thymio.state().simulator.playground === 'obstacle'")
    other_page.wait_for_function("() => window.thymio.state().simulator.playground === 'obstacle'")
