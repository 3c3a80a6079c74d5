"""Help while one writes a program: indentation, parameters of a call, renaming, definitions, parts of the program."""

from __future__ import annotations

import pytest

from tests.web_ui.page_support import KEY_MS, open_editor, open_page, wait_for_service

playwright = pytest.importorskip("playwright.sync_api")
pytestmark = [pytest.mark.browser, pytest.mark.process, pytest.mark.ros]

WRITTEN = [
    "var speed",
    "onevent prox",
    "speed = 100",
    "if speed > 50 then",
    "call leds.top(speed, 0, 0)",
    "end",
    "sub turn",
]
INDENTED = (
    "var speed\nonevent prox\n\tspeed = 100\n\tif speed > 50 then\n\t\tcall leds.top(speed, 0, 0)\n\tend\nsub turn"
)


def text_of(page):
    """The text, with its tabs."""
    return "\n".join(page.locator(".cm-content .cm-line").all_text_contents())


def place_cursor(page, line, column):
    """Put the cursor behind so many characters of a line, by keys."""
    page.focus(".cm-content")
    page.keyboard.press("Control+Home")
    for _ in range(line - 1):
        page.keyboard.press("ArrowDown")
    page.keyboard.press("Home")
    page.keyboard.press("Home")
    for _ in range(column):
        page.keyboard.press("ArrowRight")


def test_enter_after_a_complete_word_breaks_the_line_however_slowly_it_is_typed(world, page):
    open_page(page, world("base"))
    open_editor(page)
    wait_for_service(page, "/aseba_runtime/check")
    page.focus(".cm-content")
    page.keyboard.press("Control+a")
    page.keyboard.press("Delete")
    page.keyboard.type("onevent prox\nmotor.left.target = 100\nif acc[0] > 3 then\nend\n", delay=KEY_MS)
    assert text_of(page).rstrip() == "onevent prox\n\tmotor.left.target = 100\n\tif acc[0] > 3 then\n\tend"


@pytest.mark.slow
def test_writing_a_program_as_one_is_used_to(world, page):
    open_page(page, world("base"))
    open_editor(page)
    wait_for_service(page, "/aseba_runtime/check")
    page.wait_for_function("Object.values(window.thymio.state().robots).length === 1")

    page.focus(".cm-content")
    signature = page.locator(".signature")
    for line in WRITTEN:
        page.keyboard.type(line, delay=KEY_MS)
        if line.startswith("call"):
            playwright.expect(signature).to_have_count(0)  # the call is finished
        page.keyboard.press("Escape")  # the list of completions
        page.keyboard.press("Enter")
    assert text_of(page).rstrip() == INDENTED

    place_cursor(page, 7, 8)
    page.keyboard.press("Enter")
    page.keyboard.type("call leds.top(1, ", delay=KEY_MS)
    playwright.expect(signature).to_contain_text("leds.top(")
    second = signature.locator(".signature-argument")
    playwright.expect(second).to_have_count(1)
    assert signature.locator("code").inner_text().split(", ")[1] == second.inner_text()
    page.keyboard.press("Home")
    playwright.expect(signature).to_have_count(0)
    page.keyboard.press("Control+z")

    place_cursor(page, 4, 6)
    page.keyboard.press("F12")
    page.wait_for_function("getSelection().toString() === 'speed'")
    assert page.evaluate("getSelection().anchorNode.parentElement.closest('.cm-line').textContent") == "var speed"

    page.keyboard.press("F2")
    name = page.locator(".cm-rename input")
    playwright.expect(name).to_be_focused()
    name.fill("2fast")
    page.keyboard.press("Enter")
    playwright.expect(page.locator(".cm-rename")).to_contain_text("cannot be a name")
    name.fill("motor.left.target")
    page.keyboard.press("Enter")
    playwright.expect(page.locator(".cm-rename")).to_contain_text("already used")
    name.fill("tempo")
    page.keyboard.press("Enter")
    playwright.expect(page.locator(".cm-rename")).to_have_count(0)
    playwright.expect(page.locator(".cm-content")).to_be_focused()
    assert text_of(page).startswith(INDENTED.replace("speed", "tempo"))
    page.keyboard.press("Control+z")
    assert text_of(page).startswith(INDENTED)

    page.keyboard.press("Control+Shift+O")
    parts = page.locator(".outline-list button")
    playwright.expect(parts.first).to_be_focused()
    assert [" ".join(text.split()) for text in parts.all_inner_texts()] == [
        "var speed 1",
        "onevent prox 2",
        "sub turn 7",
    ]
    page.keyboard.press("ArrowUp")
    page.keyboard.press("Enter")
    page.wait_for_function("getSelection().toString() === 'turn'")
    playwright.expect(page.locator(".outline-list")).to_have_count(0)

    page.click("#file-menu")
    page.click("#file-sheet [data-verb=outline]")
    playwright.expect(parts).to_have_count(3)
    page.keyboard.press("Escape")
    playwright.expect(parts).to_have_count(0)
    page.locator(".cm-line", has_text="if speed").get_by_text("speed", exact=True).click(modifiers=["Control"])
    page.wait_for_function("getSelection().toString() === 'speed'")
