"""Themes: no serious finding of axe in open sheets; forced colors; the scene is darker while time is paused."""

from __future__ import annotations

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.web_ui.page_support import MARKS, open_hands, open_menu, open_page, open_tab, wait_for_frame
from tests.web_ui.test_page_access import AXE, findings

pytestmark = MARKS

DIMMED = "() => getComputedStyle(document.querySelector('#scene'), '::after').opacity"


@pytest.mark.slow
@pytest.mark.skipif(not AXE.exists(), reason="axe-core is not installed: npm install in web_ui")
def test_axe_finds_nothing_serious_in_sheets(world, page):
    open_page(page, world("base"))
    page.add_script_tag(path=str(AXE))
    for hand in ("hand", "tilt", "pen", "remote", "room"):
        open_hands(page, hand)
        if hand == "pen":
            page.click("[data-pen=down]")
        wait_for_frame(page)
        assert findings(page) == [], hand
        page.keyboard.press("Escape")
    open_menu(page, "[data-view=look]")
    assert findings(page) == []
    page.keyboard.press("Escape")
    page.locator("#pause").click()
    page.wait_for_function(f"() => ({DIMMED})() === '1'")
    open_menu(page, "#step-length")
    assert findings(page) == []
    page.keyboard.press("Escape")
    page.locator("#pause").click()
    page.wait_for_function(f"() => ({DIMMED})() === '0'")


def test_controls_and_what_is_chosen_are_seen_in_forced_colors(at_rest, page):
    page.emulate_media(forced_colors="active")
    open_page(page, at_rest)
    open_tab(page, "robot")
    borders = page.evaluate(
        "() => [...document.querySelectorAll('.btn, .hand, .chip')].filter((one) => one.checkVisibility())"
        ".map((one) => [one.id || one.className, getComputedStyle(one).borderTopWidth])"
    )
    assert len(borders) > 15
    assert [name for name, width in borders if width == "0px"] == []
    grounds = page.evaluate(
        "() => ['#tab-robot', '#tab-program', '[data-view=beams]', '[data-view=top]']"
        ".map((one) => getComputedStyle(document.querySelector(one)).backgroundColor)"
    )
    assert grounds[0] not in grounds[1::2], "what is chosen has another color"
    assert grounds[2] not in grounds[1::2], "what is pressed has another color"
