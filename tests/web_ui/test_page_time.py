"""Time control: steps, and the state of a program while the simulation is paused."""

from __future__ import annotations

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.web_ui.page_support import MARKS, open_menu, open_page, open_tab

pytestmark = MARKS

CLOCK = "() => document.querySelector('.clock').textContent"


def seconds(page) -> float:
    minutes, rest = page.evaluate(CLOCK).split(":")
    return 60 * int(minutes) + float(rest)


def test_a_step_has_the_selected_length_and_the_program_state_says_paused(world, page):
    open_page(page, world("base", behaviour="explorer"))
    open_tab(page, "program")
    state = page.locator("#program-state")
    playwright.expect(state).to_have_text("running")
    page.get_by_role("button", name="Pause time").click()
    playwright.expect(state).to_have_text("time is paused")
    playwright.expect(page.locator("#stage")).to_have_attribute("data-paused", "")
    step = page.locator("#time [data-verb=step]")
    playwright.expect(step).to_be_enabled()
    page.wait_for_function("() => window.thymio.state().timeNs > 0")
    for ticks, far in ((None, 0.1), ("1", 0.01), ("100", 1.0)):
        if ticks is not None:
            open_menu(page, "#step-length")
            page.click(f"[data-ticks='{ticks}']")
            playwright.expect(step).to_have_accessible_name(f"Step {far:g} s")
        page.wait_for_function(
            "() => { const {timeNs} = window.thymio.state(); const isStill = window.previous === timeNs;"
            " window.previous = timeNs; return isStill; }",
            polling=500,
        )
        before = page.evaluate(CLOCK)
        start = seconds(page)
        step.click()
        page.wait_for_function(f"(before) => ({CLOCK})() !== before", arg=before)
        page.wait_for_function(
            f"(then) => {{ const [m, s] = ({CLOCK})().split(':'); return Math.abs(60 * m + +s - then) < 0.002; }}",
            arg=start + far,
        )
    page.get_by_role("button", name="Let time run").click()
    playwright.expect(state).to_have_text("running")
    playwright.expect(page.locator("#stage")).not_to_have_attribute("data-paused", "")
