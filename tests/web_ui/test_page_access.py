"""Accessibility: no serious finding of axe in both themes; all is visible on small screens; values can be copied."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.web_ui.page_support import (
    MARKS,
    build_playground,
    choose_in_file_menu,
    choose_language,
    open_details,
    open_editor,
    open_hands,
    open_menu,
    open_page,
    open_tab,
    resize,
    wait_for_frame,
    wait_for_none,
)

pytestmark = MARKS

AXE = Path(__file__).parents[2] / "web_ui/node_modules/axe-core/axe.min.js"
FINDINGS = """async () => (await axe.run()).violations
    .filter(({impact}) => impact === "serious" || impact === "critical")
    .map(({id, nodes}) => [id, ...nodes.map(({html, any}) => html.slice(0, 120) + " " + (any[0]?.message ?? ""))])"""
OVERLAPPING = """() => {
    const outside = [];
    for (const one of document.querySelectorAll("header button, header select, #time button, #time select,"
      + " .views button, .pad button, .tab, .bar button")) {
        if (!one.checkVisibility()) continue;
        const {left, top, right, bottom} = one.getBoundingClientRect();
        const hit = document.elementFromPoint((left + right) / 2, (top + bottom) / 2);
        if (left < 0 || top < 0 || right > innerWidth || bottom > innerHeight || !one.contains(hit))
            outside.push(one.outerHTML.slice(0, 120));
    }
    return outside;
}"""


def findings(page: Any) -> list[Any]:
    """What axe finds in both themes."""
    found: list[Any] = []
    for theme in ("light", "dark"):
        page.emulate_media(color_scheme=theme, reduced_motion="reduce")
        page.evaluate("() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        found += [[theme, *finding] for finding in page.evaluate(FINDINGS)]
    return found


def findings_in_all_sizes(page: Any) -> list[Any]:
    """What axe finds, if it is installed, on a computer, a tablet and a phone. The size is as before afterwards."""
    if not AXE.exists():
        return []
    page.add_script_tag(path=str(AXE))
    before = page.viewport_size
    found: list[Any] = []
    for width, height in ((1024, 768), (820, 1180), (390, 844)):
        resize(page, width, height)
        found += [[width, *finding] for finding in findings(page)]
    resize(page, before["width"], before["height"])
    return found


@pytest.mark.slow
@pytest.mark.skipif(not AXE.exists(), reason="axe-core is not installed: npm install in web_ui")
def test_axe_finds_nothing_serious(world, page):
    open_page(page, world("two_robots", behaviour="menu"))
    page.wait_for_function("() => Object.keys(window.thymio.state().robots).length === 2")
    page.add_script_tag(path=str(AXE))
    assert findings(page) == []
    open_menu(page, "#robot-chooser")
    assert findings(page) == []
    page.keyboard.press("Escape")
    for entry, shown in (("keys", ".welcome-keys"), ("tour", ".tour"), ("start", ".welcome-starts")):
        open_menu(page, "#help-open")
        page.click(f"[data-help={entry}]")
        page.locator(shown).wait_for()
        assert findings(page) == [], entry
        if entry != "start":
            page.keyboard.press("Escape")
    page.click("[data-start=ros]")
    page.locator("#welcome-ros").wait_for()
    assert findings(page) == [], "ROS"
    page.keyboard.press("Escape")
    for tab in ("robot", "class", "playground"):
        open_tab(page, tab)
        wait_for_frame(page)
        assert findings(page) == [], tab
    build_playground(page)
    page.locator("#view").press("n")
    page.locator(".item-form").wait_for()
    assert findings(page) == [], "creator"
    open_editor(page)
    page.focus(".cm-content")
    page.keyboard.press("Control+a")
    page.keyboard.insert_text("var a\nif a = 1 then\nend")
    page.locator(".mistake-card").wait_for()
    assert findings(page) == [], "mistake"
    choose_in_file_menu(page, "new")
    page.locator("[data-new=button]").wait_for()
    assert findings(page) == [], "ways to begin"
    page.locator("#view").focus()
    page.keyboard.press("m")
    open_menu(page, "[data-view=look]")
    page.locator("#numbers").check()
    page.wait_for_function("() => document.querySelectorAll('.ray-number:not([hidden])').length > 0")
    assert findings(page) == []


def test_at_800_by_600_every_control_is_visible_in_every_language(at_rest, page):
    page.set_viewport_size({"width": 800, "height": 600})
    open_page(page, at_rest)
    for language in ("de", "fr", "it", "en"):
        choose_language(page, language)
        wait_for_frame(page)
        wait_for_none(page, OVERLAPPING)


@pytest.mark.slow
@pytest.mark.parametrize("size", [(683, 384), (360, 640)])
def test_in_a_low_window_views_and_some_lines_of_the_program_are_visible(at_rest, page, size):
    page.set_viewport_size({"width": size[0], "height": size[1]})  # 1366 × 768 at 200 %; a small phone
    open_page(page, at_rest, unfold=False)
    wait_for_frame(page)
    wait_for_none(page, OVERLAPPING)
    open_editor(page)
    page.wait_for_function("() => document.querySelector('.cm-scroller')?.getBoundingClientRect().height > 120")
    page.locator(".constants > summary").click()
    page.fill("[data-new=constant]", "FAR")


@pytest.mark.slow
def test_values_can_be_frozen_and_copied(world, page):
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    open_page(page, world("base"))
    open_details(page)
    page.wait_for_function("() => window.thymio.state().robot.raw.battery !== undefined")
    for sensor in ("accelerometer", "temperature", "sound", "battery"):
        page.wait_for_function("(sensor) => window.thymio.state().robot.raw[sensor] !== undefined", arg=sensor)
    page.get_by_role("cell", name="22.0 °C").wait_for()
    freeze = page.locator("[data-values=hold]")
    freeze.click()
    open_hands(page)
    page.locator("[data-operate=temperature]").fill("45")
    page.wait_for_function("() => window.thymio.state().robot.raw.temperature[0] === 450")
    page.keyboard.press("Escape")
    page.locator("[data-values=copy]").click()
    page.wait_for_function(
        "async (line) => (await navigator.clipboard.readText()).includes(line)", arg="temperature\t22.0 °C\t220"
    )
    freeze.click()
    page.get_by_role("cell", name="45.0 °C").wait_for()
