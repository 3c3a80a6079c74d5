"""Themes: no serious finding of axe in the dark one, also in open sheets; the scene is darker while time is paused."""

from __future__ import annotations

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.web_ui.page_support import MARKS, open_hands, open_menu, open_page, open_tab, wait_for_frame
from tests.web_ui.test_page_access import AXE, FINDINGS

pytestmark = MARKS

DIMMED = "() => getComputedStyle(document.querySelector('#scene'), '::after').opacity"


@pytest.mark.skipif(not AXE.exists(), reason="axe-core is not installed: npm install in web_ui")
@pytest.mark.parametrize("theme", ["dark", "light"])
def test_axe_finds_nothing_serious_in_sheets(suite, page, theme):
    page.emulate_media(color_scheme=theme, reduced_motion="reduce")
    open_page(page, suite("--playground", "base", "--program", "none"))
    page.add_script_tag(path=str(AXE))
    for hand in ("hand", "tilt", "pen", "remote", "room"):
        open_hands(page, hand)
        if hand == "pen":
            page.click("[data-pen=down]")
        wait_for_frame(page)
        assert page.evaluate(FINDINGS) == [], hand
        page.keyboard.press("Escape")
    open_menu(page, "[data-view=look]")
    assert page.evaluate(FINDINGS) == []
    page.keyboard.press("Escape")
    page.locator("#pause").click()
    page.wait_for_function(f"() => ({DIMMED})() === '1'")
    open_menu(page, "#step-length")
    assert page.evaluate(FINDINGS) == []
    page.keyboard.press("Escape")
    page.locator("#pause").click()
    page.wait_for_function(f"() => ({DIMMED})() === '0'")


def test_controls_have_borders_in_forced_colors(at_rest, page):
    page.emulate_media(forced_colors="active")
    open_page(page, at_rest)
    open_tab(page, "robot")
    borders = page.evaluate(
        "() => [...document.querySelectorAll('.btn, .hand, .chip')].filter((one) => one.checkVisibility())"
        ".map((one) => [one.id || one.className, getComputedStyle(one).borderTopWidth])"
    )
    assert len(borders) > 15
    assert [name for name, width in borders if width == "0px"] == []
