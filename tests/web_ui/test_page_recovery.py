"""Recovery after a lost connection or a restart, and several browsers at once."""

from __future__ import annotations

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.processes import free_port, wait_for_port
from tests.web_ui.page_support import MARKS, open_page, wait_for_service

pytestmark = MARKS

PAUSED = "() => window.thymio.state().simulator?.paused === true"


def test_the_page_reconnects_to_a_restarted_simulator_and_discards_old_state(suite, page):
    ports = (free_port(), free_port())
    open_page(page, suite("--playground", "two_robots", "--program", "none", ports=ports))
    page.wait_for_function("() => Object.keys(window.thymio.state().robots).length === 2")
    suite.end()
    page.wait_for_function("() => !window.thymio.connected")
    banner = page.locator(".banner:not([hidden])")
    playwright.expect(banner).to_contain_text("Retrying every second")
    suite("--playground", "base", "--program", "none", ports=ports)
    wait_for_port(ports[1])
    page.wait_for_function("() => window.thymio.connected")
    page.wait_for_function("() => window.thymio.state().simulator?.playground === 'base'")
    page.wait_for_function("() => Object.keys(window.thymio.state().robots).length === 1")
    page.wait_for_function("() => Boolean(window.thymio.state().robot?.latest)")
    playwright.expect(banner).to_have_count(0)
    playwright.expect(page.locator(".chip[data-state]")).to_have_attribute("data-state", "connected")


LOCKED = (
    ".dpad button, .card.program .verbs button, #playground-choice, #gallery-open, .time button, .time select, .stop"
)
STATES = """(controls) => [...document.querySelectorAll(controls)]
    .map((one) => [one.matches(":disabled"), one.title || one.closest("fieldset")?.title || ""])"""


def test_controls_are_disabled_with_a_reason_while_the_simulator_is_gone(suite, page):
    ports = (free_port(), free_port())
    arguments = ("--playground", "base", "--behaviour", "menu")
    open_page(page, suite(*arguments, ports=ports))
    page.wait_for_function("window.thymio.state().program?.state === 'running'")
    page.click("#editor-switch")
    page.locator(".cm-content").wait_for()
    suite.end()
    page.wait_for_function("() => !window.thymio.connected")
    load = page.locator("[data-verb=load]")
    playwright.expect(load).to_be_disabled()
    page.focus(".cm-content")
    page.keyboard.press("Control+End")
    page.keyboard.insert_text("# kept")
    page.click("#editor-switch")
    stimuli = ".card.stimuli input, .card.stimuli button, .card.stimuli select"
    states = page.evaluate(STATES, f"{LOCKED}, {stimuli}")
    assert len(states) > 30
    assert all(disabled for disabled, _ in states)
    assert {title for _, title in page.evaluate(STATES, LOCKED)} == {"Not connected to the simulator"}
    suite(*arguments, ports=ports)
    wait_for_port(ports[1])
    page.wait_for_function("window.thymio.connected && window.thymio.state().program?.state === 'running'")
    playwright.expect(page.locator(".time button.primary")).to_be_enabled()
    page.locator(".time button.primary").click()
    page.wait_for_function(PAUSED)
    playwright.expect(page.locator(".dpad button").first).to_be_enabled()
    playwright.expect(page.locator(".dpad button").first).to_have_attribute("title", "Forward")
    for states in (page.evaluate(STATES, LOCKED), page.evaluate(STATES, stimuli)):
        assert not any(disabled for disabled, _ in states)
    page.click("#editor-switch")
    playwright.expect(page.locator(".cm-content")).to_contain_text("# kept")


NO_STORAGE = """Object.defineProperty(window, "localStorage", {
    get() { throw new DOMException("The browser keeps nothing.", "SecurityError"); }
})"""


def test_the_page_works_without_browser_storage(suite, page):
    page.add_init_script(NO_STORAGE)
    open_page(page, suite("--playground", "base", "--program", "none"))
    page.select_option("header .language", "fr")
    playwright.expect(page.locator(".stop")).to_contain_text("Arrêt")
    page.click(".card.program summary")
    page.click("#editor-switch")
    page.focus(".cm-content")
    page.keyboard.insert_text("var a")
    page.click("#creator-switch")
    page.locator("#creator-try").wait_for()
    page.click("#editor-switch")
    playwright.expect(page.locator(".cm-content")).to_contain_text("var a")


def test_the_editor_shows_errors_after_a_restart_and_a_failed_load_is_reported(suite, page):
    ports = (free_port(), free_port())
    open_page(page, suite("--playground", "base", "--program", "none", ports=ports))
    wait_for_service(page, "/aseba_runtime/check")
    page.click("#editor-switch")
    verdict = page.locator(".verdict")
    playwright.expect(verdict).to_contain_text("No errors")
    suite.end()
    page.wait_for_function("() => !window.thymio.connected")
    page.focus(".cm-content")
    page.keyboard.insert_text("var a = b")
    playwright.expect(verdict).to_contain_text("Errors appear when the Aseba runtime is connected")
    page.click("#creator-switch")
    playwright.expect(page.locator(".notice")).to_contain_text("Reload the page")
    suite("--playground", "base", "--program", "none", ports=ports)
    playwright.expect(verdict).to_contain_text("no variable is called 'b'")


def test_actions_in_one_browser_are_visible_in_one_that_connects_late(suite, page, other_page):
    address = suite("--playground", "base", "--program", "none")
    open_page(page, address)
    page.locator("#view").focus()
    page.locator(".time button.primary").click()
    page.wait_for_function(PAUSED)
    open_page(other_page, address)
    other_page.wait_for_function(PAUSED)
    other_page.wait_for_function("() => window.thymio.state().markers > 0 && window.thymio.state().program !== null")
    other_page.wait_for_function("() => window.thymio.state().playgrounds.length > 3")
    other_page.locator(".time button.primary").click()
    page.wait_for_function("() => window.thymio.state().simulator.paused === false")
    other_page.select_option("#playground-choice", "obstacle")
    page.wait_for_function("() => window.thymio.state().simulator.playground === 'obstacle'")
    other_page.wait_for_function("() => window.thymio.state().simulator.playground === 'obstacle'")
