"""A lesson without a mouse: choose a playground, open and change a program, run, break, step, drive, stop."""

from __future__ import annotations

from typing import Any

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.web_ui.page_support import (
    MARKS,
    build_playground,
    choose_language,
    drop_file,
    open_details,
    open_editor,
    open_page,
    open_tab,
    wait_for_service,
)

pytestmark = MARKS

PROGRAM = """\
var presses = 0
onevent button.forward
presses = presses + button.forward
motor.left.target = 150 * button.forward
motor.right.target = 150 * button.forward
"""
MOST_TABS = 150
STATE = "() => window.thymio.state()"
STOP = """() => {
    const one = document.activeElement;
    if (one === null || one === document.body) return null;
    const {left, top, right, bottom} = one.getBoundingClientRect();
    const parts = [0.5, 0.1, 0.9];
    const isSeen = parts.some((x) => parts.some((y) => {
        const hit = document.elementFromPoint(left + x * (right - left), top + y * (bottom - top));
        return hit !== null && (one.contains(hit) || one.closest("label, .switch")?.contains(hit));
    }));
    const hasRing = [one, one.parentElement, one.nextElementSibling].some((element) => {
        const {boxShadow, outlineStyle} = element === null ? {} : getComputedStyle(element);
        return element && (boxShadow !== "none" || outlineStyle !== "none");
    });
    const tabs = one.role === "tab" ? one.closest("[role=tablist]").outerHTML.slice(0, 100) : null;
    return {name: one.id || one.outerHTML.slice(0, 100), isSeen, hasRing, tabs, isText: one.matches(".cm-content")};
}"""


def go_to(page: Any, selector: str, key: str = "Tab") -> None:
    """Press a key until an element has the focus, as a user would."""
    for _ in range(MOST_TABS):
        if page.evaluate("(selector) => document.activeElement?.matches(selector) ?? false", selector):
            return
        page.keyboard.press(key)
    pytest.fail(f"{MOST_TABS} times {key} do not lead to {selector}")


def expect(page: Any, selector: str) -> Any:
    return playwright.expect(page.locator(selector))


def test_a_whole_lesson_by_keyboard(world, own_page, tmp_path):
    page = own_page
    file = tmp_path / "drive.aesl"
    file.write_text(f'<network>\n<node nodeId="1" name="thymio-II">{PROGRAM}</node>\n</network>\n')
    page.set_viewport_size({"width": 1280, "height": 720})
    page.on("filechooser", lambda _chooser: None)  # from now on, so that no dialog of the system opens
    open_page(page, world("line"))

    go_to(page, "#tab-robot")
    page.keyboard.press("ArrowUp")
    expect(page, "#tab-playground").to_be_focused()
    page.keyboard.press("Enter")
    expect(page, "[data-playground=base]").to_have_count(1)
    go_to(page, "[data-playground=base]")
    page.keyboard.press("Enter")
    page.wait_for_function(f"({STATE})().simulator.playground === 'base'")

    go_to(page, "#tab-playground", "Shift+Tab")
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("Enter")
    page.locator("[data-new=vpl-empty]:focus").wait_for()  # the tab asks how to begin
    go_to(page, "[data-new=empty]")
    page.keyboard.press("Enter")
    page.locator(".cm-content:focus").wait_for()  # the text has the cursor in it
    page.keyboard.press("Escape")
    go_to(page, "#file-menu", "Shift+Tab")
    page.keyboard.press("Enter")
    go_to(page, "#file-sheet .file button")
    with page.expect_file_chooser() as chooser:
        page.keyboard.press("Enter")
    chooser.value.set_files(str(file))
    expect(page, ".cm-content").to_contain_text("presses + button.forward")

    go_to(page, ".cm-content")
    page.keyboard.press("Control+End")
    page.keyboard.insert_text("call leds.top(0, 32 * button.forward, 0)\n")
    expect(page, ".verdict").to_contain_text("No mistakes")
    page.keyboard.press("F9")
    page.wait_for_function(f"({STATE})().program?.name === 'drive.aesl'")

    page.keyboard.press("Control+Home")
    page.keyboard.press("ArrowDown")
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Control+b")
    expect(page, ".breakpoints .breakpoint:visible").to_have_count(1)
    page.wait_for_function(
        f"({STATE})().program?.values.breakpoints === '[4]'"
    )  # of the file: its first line is <network>

    page.keyboard.press("Escape")
    go_to(page, "#view", "Shift+Tab")
    page.keyboard.down("ArrowUp")
    page.wait_for_function(f"({STATE})().robot.buttons.forward")
    expect(page, "#program-state").to_have_text("halted in line 3")
    wait_for_service(page, "/aseba/step_line", "/aseba/run", "/aseba/stop")
    page.keyboard.press("F7")
    expect(page, ".current-line").to_have_text("motor.left.target = 150 * button.forward")
    expect(page, "[data-variable=presses]").to_have_text("1")
    page.keyboard.press("F9")
    page.wait_for_function(f"({STATE})().robot.wheelSpeeds.left > 1 && ({STATE})().robot.wheelSpeeds.right > 1")
    page.wait_for_function(f"Math.max(...(({STATE})().robot.leds.top ?? [])) === 1")

    page.keyboard.press("Escape")
    page.wait_for_function(f"({STATE})().program?.state === 'stopped'")
    page.wait_for_function(f"Math.abs(({STATE})().robot.wheelSpeeds.left) < 0.1")
    page.keyboard.up("ArrowUp")
    page.wait_for_function(f"!({STATE})().robot.buttons.forward")
    expect(page, "#live").to_contain_text("stopped")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("language", "error", "help_text"),
    [
        ("de", "keine Variable heißt 'motor.left.targt'; vielleicht ist 'motor.left.target' gemeint", "gewünschte"),
        ("fr", "aucune variable ne s’appelle 'motor.left.targt'", "vitesse voulue"),
        ("it", "nessuna variabile si chiama 'motor.left.targt'", "velocità voluta"),
    ],
)
def test_editor_and_program_panel_show_errors_in_the_language_of_the_page(
    world, page, tmp_path, language, error, help_text
):
    broken = tmp_path / "broken.aesl"
    broken.write_text("onevent prox\nmotor.left.targt = 1\n")
    open_page(page, world("base"))
    choose_language(page, language)
    page.wait_for_function("() => window.thymio.state().services.includes('/aseba_runtime/check')")
    drop_file(page, broken, "#view")
    expect(page, ".notice.error").to_contain_text(error)
    open_editor(page)  # with the text, at the mistake
    expect(page, ".mistake-card").to_contain_text(error[1:])  # as a sentence
    page.click("#tool-tab-reference")
    page.fill(".reference input", "motor.left.target")
    expect(page, ".reference .entry-help:visible p").to_contain_text(help_text)


@pytest.mark.slow
def test_letter_keys_work_with_caps_lock(at_rest, page):
    open_page(page, at_rest)
    page.focus("#view")
    page.keyboard.press("T")  # without Shift, as with Caps Lock
    playwright.expect(page.get_by_role("button", name="Above")).to_have_attribute("aria-pressed", "true")
    open_editor(page)
    page.focus(".cm-content")
    with page.expect_download() as saved:
        page.keyboard.press("Control+S")
    assert saved.value.suggested_filename == "My program.aesl"
    build_playground(page)
    page.focus("#view")
    for key, selected in (("N", "ground"), ("N", "thymio"), ("Shift+N", "ground")):
        page.keyboard.press(key)
        page.wait_for_function("(name) => window.thymio.built().selected === name", arg=selected)


def stops(page: Any) -> list[str]:
    """Names of all elements that Tab leads to, once around; each is seen when it has the focus, and shows that."""
    page.locator(".skip").focus()
    found: list[dict[str, Any]] = []
    while len(found) < MOST_TABS:
        stop = page.evaluate(STOP)
        if stop is None or (found and stop["name"] == found[0]["name"]):
            break
        found.append(stop)
        if stop["isText"]:
            page.keyboard.press("Escape")  # then Tab leaves it
        page.keyboard.press("Tab")
    assert [stop for stop in found if not (stop["isSeen"] and stop["hasRing"])] == []
    lists = [stop["tabs"] for stop in found if stop["tabs"] is not None]
    assert len(lists) == len(set(lists)) > 0, "one stop per list of tabs: arrows lead to the others"
    return [stop["name"] for stop in found]


@pytest.mark.slow
def test_tab_leads_everywhere_and_the_focus_is_always_seen(world, page):
    open_page(page, world("two_robots"))
    page.wait_for_function(f"() => Object.keys(({STATE})().robots).length === 2")
    stage = {"robot-chooser", "stop", "view", "pause", "tray-fold"}
    open_details(page)
    assert stage <= set(stops(page))
    open_tab(page, "class")
    page.locator(".class-tile").first.wait_for()
    assert stage <= set(stops(page))
    open_tab(page, "playground")
    assert stage <= set(stops(page))
    build_playground(page)
    assert {"stop", "view", "creator-try", "creator-more", "creator-snap"} <= set(stops(page))
    open_editor(page)
    assert stage | {"file-menu", "tool-tab-values"} <= set(stops(page))


@pytest.mark.slow
def test_the_focus_is_not_lost_with_what_had_it(world, page, tmp_path):
    broken = tmp_path / "broken.aesl"
    broken.write_text("onevent prox\nmotor.left.targt = 1\n")
    open_page(page, world("base"))
    page.wait_for_function("() => window.thymio.state().services.includes('/aseba_runtime/check')")
    drop_file(page, broken, "#view")
    go_to(page, ".notice button")
    page.keyboard.press("Enter")
    expect(page, "#view").to_be_focused()
    go_to(page, "#help-open", "Shift+Tab")
    page.keyboard.press("Enter")
    page.locator("[role=menuitem]:focus").wait_for()
    for _ in range(3):
        page.keyboard.press("ArrowDown")
    playwright.expect(page.get_by_role("menuitem", name="Keys")).to_be_focused()
    page.keyboard.press("Enter")
    playwright.expect(page.get_by_role("dialog", name="Keys")).to_be_visible()
    page.keyboard.press("Escape")
    expect(page, "#help-open").to_be_focused()


@pytest.mark.slow
def test_an_open_menu_keeps_the_focus_when_the_editor_comes_late(world, page):
    held = []
    page.route("**/assets/editor-*.js", lambda route: held.append(route))
    open_page(page, world("base", "explorer"))
    open_tab(page, "program")
    page.locator(".program[data-shown=program]").wait_for()
    page.locator("#file-menu").press("Enter")
    page.locator("#file-sheet .file-name").focus()
    for route in held:
        route.continue_()
    page.locator(".cm-content").wait_for(state="attached")
    assert held
    assert page.evaluate("() => document.activeElement.matches('#file-sheet .file-name')")
