"""Accessibility: no serious finding of axe, in every language and on small screens; values can be copied."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.web_ui.page_support import (
    MARKS,
    choose_language,
    open_details,
    open_editor,
    open_hands,
    open_menu,
    open_page,
    open_tab,
    wait_for_frame,
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


@pytest.mark.skipif(not AXE.exists(), reason="axe-core is not installed: npm install in web_ui")
def test_axe_finds_nothing_serious(suite, page):
    open_page(page, suite("--playground", "two_robots", "--behaviour", "menu"))
    page.wait_for_function("() => Object.keys(window.thymio.state().robots).length === 2")
    page.add_script_tag(path=str(AXE))
    assert page.evaluate(FINDINGS) == []
    for tab in ("robot", "playground"):
        open_tab(page, tab)
        wait_for_frame(page)
        assert page.evaluate(FINDINGS) == []
    open_editor(page)
    assert page.evaluate(FINDINGS) == []
    open_menu(page, "#robot-chooser")
    assert page.evaluate(FINDINGS) == []
    page.keyboard.press("Escape")
    page.locator("#view").focus()
    page.keyboard.press("m")
    open_menu(page, "[data-view=look]")
    page.locator("#numbers").check()
    page.wait_for_function("() => document.querySelectorAll('.ray-number:not([hidden])').length > 0")
    assert page.evaluate(FINDINGS) == []


def test_at_800_by_600_every_control_is_visible_in_every_language(at_rest, page):
    page.set_viewport_size({"width": 800, "height": 600})
    open_page(page, at_rest)
    for language in ("de", "fr", "it", "en"):
        choose_language(page, language)
        wait_for_frame(page)
        assert page.evaluate(OVERLAPPING) == []


@pytest.mark.parametrize("size", [(683, 384), (360, 640)])
def test_in_a_low_window_views_and_some_lines_of_the_program_are_visible(at_rest, page, size):
    page.set_viewport_size({"width": size[0], "height": size[1]})  # 1366 × 768 at 200 %; a small phone
    open_page(page, at_rest, unfold=False)
    wait_for_frame(page)
    assert page.evaluate(OVERLAPPING) == []
    open_editor(page)
    page.wait_for_function("() => document.querySelector('.cm-scroller')?.getBoundingClientRect().height > 120")
    page.locator(".constants > summary").click()
    page.fill("[data-new=constant]", "FAR")


def test_values_can_be_frozen_and_copied(suite, page):
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    open_page(page, suite("--playground", "base", "--program", "none"))
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
