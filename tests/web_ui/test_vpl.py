"""VPL in a real Chromium against the running suite: built by mouse, keyboard and touch, run, opened, made text."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.web_ui.page_support import (
    MARKS,
    TouchPoints,
    choose_in_file_menu,
    choose_language,
    drop_file,
    open_page,
    open_tab,
    wait_for_frame,
    watch_it_avoid,
)
from tests.web_ui.test_page_access import AXE, FINDINGS

pytestmark = MARKS

FILES = Path(__file__).parents[1] / "data" / "web" / "vpl"
ROWS = "() => document.querySelectorAll('.vpl-row').length"


def expect(page: Any, selector: str, **options: Any) -> Any:
    return playwright.expect(page.locator(selector, **options))


def begin(page: Any, sample: str) -> None:
    """Begin with a sample of VPL."""
    open_tab(page, "program")
    page.locator(".program[data-shown=start], .program[data-shown=program]").wait_for()
    card = page.locator(f"[data-new=vpl-{sample}]")
    if page.locator(".program[data-shown=program]").is_visible():
        choose_in_file_menu(page, "new")
    if not card.is_visible():
        page.locator("[data-samples=vpl] .program-more summary").click()
    card.click()
    page.locator(".vpl-rows").wait_for()


def place(row: int, slot: str, index: int = 0) -> str:
    return f"[data-place='{row} {slot} {index}']"


def middle(page: Any, selector: str) -> tuple[float, float]:
    page.locator(selector).first.scroll_into_view_if_needed()
    box = page.locator(selector).first.bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def drag(page: Any, source: str, target: str) -> None:
    """Drag by mouse from one element to another."""
    x, y = middle(page, source)
    page.mouse.move(x, y)
    page.mouse.down()
    to_x, to_y = middle(page, target)
    page.mouse.move((x + to_x) / 2, (y + to_y) / 2, steps=3)
    page.mouse.move(to_x, to_y, steps=3)
    page.locator(".vpl-ghost").wait_for()
    page.mouse.up()
    page.locator(".vpl-ghost").wait_for(state="detached")


def blocks(page: Any, row: int) -> list[str]:
    """The names of the blocks of a row, after the next frame."""
    wait_for_frame(page)
    return page.locator(f"[data-row='{row}'] [data-block]").evaluate_all(
        "(all) => all.map((each) => each.dataset.block)"
    )


def close_sheet(page: Any) -> None:
    page.locator("#vpl-block [data-block-verb=done]").click()
    page.locator("#vpl-block").wait_for(state="hidden")


def set_sensors(page: Any, row: int, states: dict[int, int]) -> None:
    """Press the sensors of a block of distances until they have these states."""
    page.locator(place(row, "event")).click()
    for sensor, times in states.items():
        for _ in range(times):
            page.locator("#vpl-block .vpl-part").nth(sensor).click()
            wait_for_frame(page)  # the next click starts from what this one has changed
    close_sheet(page)


def set_slider(page: Any, look: str, value: str) -> None:
    """Move a slider by keys until it shows a value."""
    slider = page.locator(f"#vpl-block [data-look={look}] input")
    if look in ("left", "right"):  # upright, as in the picture of the block
        box = slider.bounding_box()
        assert box["height"] > 2 * box["width"]
    key = "ArrowRight" if value.lstrip("-").isdigit() and int(value) > 0 else "ArrowLeft"
    for _ in range(40):
        if page.locator(f"#vpl-block [data-look={look}] output").inner_text() == value:
            return
        slider.press(key)
        wait_for_frame(page)
    raise AssertionError(f"{look} never showed {value}")


def test_an_obstacle_avoider_is_built_by_mouse_runs_and_becomes_text(world, page):
    page.set_viewport_size({"width": 1280, "height": 900})
    open_page(page, world("base"))
    page.add_script_tag(content=AXE.read_text(encoding="utf-8"))
    begin(page, "empty")
    assert page.evaluate(FINDINGS) == []

    # by clicks, and by dragging
    page.locator("[data-new-block=prox]").click()
    assert blocks(page, 0) == ["prox"]
    expect(page, "[data-row='0'] .vpl-why").to_contain_text("add an action")
    playwright.expect(page.get_by_role("button", name="Run program")).to_be_disabled()
    page.locator("[data-new-block=move]").click()
    drag(page, "[data-new-block=colortop]", "[data-row='0'] .vpl-actions")
    assert blocks(page, 0) == ["prox", "move", "colortop"]
    set_sensors(page, 0, dict.fromkeys(range(5), 2))  # all far
    expect(page, place(0, "event")).to_have_attribute(
        "aria-label", "Near or far: far left: far, left: far, middle: far, right: far, far right: far"
    )
    page.locator(place(0, "actions", 0)).click()
    set_slider(page, "left", "200")
    set_slider(page, "right", "200")
    assert page.evaluate(FINDINGS) == []
    close_sheet(page)
    expect(page, ".program-code").to_contain_text("motor.left.target = 200")

    # the second row: near in the middle; then one like it is an error at its place
    drag(page, "[data-new-block=prox]", "[data-row='1'] .vpl-slot.event")
    set_sensors(page, 1, {2: 1})
    page.locator("[data-new-block=move]").click()
    page.locator(place(1, "actions", 0)).click()
    set_slider(page, "left", "150")
    set_slider(page, "right", "-150")
    close_sheet(page)
    page.locator(place(1, "row")).click()
    page.locator("[data-row-verb=copy]").click()
    expect(page, ".vpl-row.wrong").to_have_count(2)
    expect(page, "[data-row='2'] .vpl-why").to_contain_text("same event")
    set_sensors(page, 2, {2: 2, 0: 1, 1: 1})
    expect(page, ".vpl-row.wrong").to_have_count(0)

    # Ctrl copies; undo takes it back
    page.keyboard.down("Control")
    drag(page, place(0, "actions", 1), "[data-row='1'] .vpl-actions")
    page.keyboard.up("Control")
    assert [blocks(page, row) for row in (0, 1)] == [["prox", "move", "colortop"]] * 2
    page.locator("[data-vpl=undo]").click()
    assert blocks(page, 1) == ["prox", "move"]
    page.locator("[data-vpl=redo]").click()
    assert blocks(page, 1) == ["prox", "move", "colortop"]
    drag(page, place(1, "actions", 1), ".vpl-palette.action")
    assert blocks(page, 1) == ["prox", "move"]

    # it runs, its rows flash, and the robot avoids
    page.get_by_role("button", name="Run program").click()
    expect(page, "#program-state").to_have_attribute("data-state", "running")
    page.wait_for_function("() => document.querySelector('.vpl-ran:not([hidden])') !== null")
    watch_it_avoid(page, world)

    # as text, read-only; turned into text; back
    page.locator("[data-language=text]").click()
    expect(page, ".program-language").to_contain_text("made from blocks")
    page.locator(".cm-content").click()
    page.keyboard.type("x")
    expect(page, ".cm-content").not_to_contain_text("x # reset")
    page.locator("[data-detach=turn]").click()
    expect(page, ".program-language").to_contain_text("left this program")
    page.locator("[data-detach=undo]").click()
    page.locator(".vpl-rows").wait_for()
    assert blocks(page, 1) == ["prox", "move"]
    for language in ("de", "fr", "it", "en"):
        choose_language(page, language)
        page.locator(".vpl-row").first.wait_for()
        assert page.evaluate(FINDINGS) == []

    # as blocks, which avoid as well; the rows stay among the last programs
    name = page.locator("#file-menu .name").inner_text()
    choose_in_file_menu(page, "blocks")
    page.locator(".blocks .blocklySvg").first.wait_for()
    expect(page, ".blocks-verdict").to_have_text("No mistakes")
    expect(page, ".blocklyBlockCanvas .thymio_when").to_have_count(3)
    page.get_by_role("button", name="Run program").click()
    watch_it_avoid(page, world)
    choose_in_file_menu(page, "new")
    page.locator(f"[data-recent='{name}']").first.click()
    page.locator(".vpl-rows").wait_for()
    assert blocks(page, 1) == ["prox", "move"]


@pytest.mark.slow
def test_a_program_is_built_by_keyboard_alone(world, page):
    open_page(page, world("base"))
    begin(page, "empty")
    page.locator(place(0, "event")).focus()
    for key in ("Enter", "Enter"):  # the slot, then the first block of the palette: buttons
        page.keyboard.press(key)
        wait_for_frame(page)
    assert blocks(page, 0) == ["button"]
    page.keyboard.press("Enter")  # its editor: forward
    page.keyboard.press("Enter")
    page.keyboard.press("Escape")
    expect(page, place(0, "event")).to_have_attribute("aria-label", "Buttons: forward")
    page.locator(place(0, "event")).focus()
    page.keyboard.press("ArrowRight")
    expect(page, place(0, "actions")).to_be_focused()
    page.keyboard.press("Enter")
    page.keyboard.press("Enter")
    wait_for_frame(page)
    assert blocks(page, 0) == ["button", "move"]
    page.keyboard.press("Control+d")
    wait_for_frame(page)
    assert page.evaluate(ROWS) == 3
    page.keyboard.press("Delete")  # the copy, whose number has the focus
    wait_for_frame(page)
    assert page.evaluate(ROWS) == 2
    page.keyboard.press("Control+z")
    wait_for_frame(page)
    assert page.evaluate(ROWS) == 3
    page.keyboard.press("Control+z")
    wait_for_frame(page)
    assert page.evaluate(ROWS) == 2


@pytest.mark.slow
def test_a_row_in_which_nothing_is_chosen_has_a_warning(world, page, tmp_path):
    text = (FILES / "current.aesl").read_text(encoding="utf-8")
    text = text.replace('value2="1" value3="0"', 'value2="0" value3="0"')
    (tmp_path / "open.aesl").write_text(text, encoding="utf-8")
    open_page(page, world("base"))
    open_tab(page, "program")
    page.locator(".program[data-shown=start], .program[data-shown=program]").wait_for()
    drop_file(page, tmp_path / "open.aesl", ".program")
    expect(page, ".vpl-row .vpl-why").to_have_text("Row 2: no sensor is chosen, so this happens all the time.")
    drop_file(page, FILES / "current.aesl", ".program")
    expect(page, ".vpl-row .vpl-why").to_have_count(0)


@pytest.fixture
def phone(touch_page) -> Any:
    """A checked page on a phone in portrait."""
    touch_page.set_viewport_size({"width": 390, "height": 844})
    return touch_page


@pytest.mark.slow
def test_programs_of_both_kinds_of_blocks_are_built_by_fingers_on_a_phone(world, phone):
    open_page(phone, world("base"))
    begin(phone, "buttons")
    assert blocks(phone, 0) == ["button", "move", "colortop"]
    fingers = TouchPoints(phone)
    x, y = middle(phone, place(0, "actions", 1))
    fingers.start(a=(x, y))
    fingers.move(a=(x - 40, y))
    phone.locator(".vpl-ghost").wait_for()
    fingers.move(a=middle(phone, place(0, "actions", 0)))
    fingers.end()
    phone.locator(".vpl-ghost").wait_for(state="detached")
    assert blocks(phone, 0) == ["button", "colortop", "move"]
    fingers.start(a=middle(phone, place(0, "actions", 0)))
    phone.locator(".vpl-ghost.copy").wait_for()  # a long press copies
    fingers.end()
    phone.locator(place(0, "event")).tap()
    phone.locator("#vpl-block .vpl-part").nth(1).tap()
    wait_for_frame(phone)
    box = phone.locator("#vpl-block").bounding_box()
    assert 0 <= box["x"] <= 390 - box["width"]
    close_sheet(phone)
    expect(phone, place(0, "event")).to_have_attribute("aria-label", "Buttons: forward, left")
    phone.add_script_tag(content=AXE.read_text(encoding="utf-8"))
    assert phone.evaluate(FINDINGS) == []

    phone.set_viewport_size({"width": 390, "height": 700})  # as beside an open mission
    choose_in_file_menu(phone, "new")
    phone.locator("[data-new=blocks-empty]").tap()
    phone.locator(".blocklyToolbox[layout=h]").wait_for()
    phone.locator(".blocklyToolboxCategory", has_text="Motors").tap()
    new = ".blocklyFlyout:visible .thymio_motors_start"
    phone.locator(new).first.wait_for()
    box, area = (phone.locator(each).first.bounding_box() for each in (new, ".blocks-place"))
    fingers.start(a=(box["x"] + 4, box["y"] + 20))
    fingers.move(a=(area["x"] + 60, area["y"] + 60))
    fingers.end()
    expect(phone, ".blocklyBlockCanvas > .thymio_motors_start:visible").to_have_count(1)
    expect(phone, ".blocks-verdict").to_have_text("No mistakes")
    assert phone.evaluate(FINDINGS) == []


@pytest.mark.slow
def test_older_files_and_a_teachers_list_are_opened(world, page):
    page.set_viewport_size({"width": 800, "height": 600})
    open_page(page, world("base"), unfold=False)
    open_tab(page, "program")
    page.locator(".program[data-shown=start]").wait_for()
    drop_file(page, FILES / "format0.aesl", ".program")
    expect(page, ".vpl-notices").to_contain_text("older VPL")
    expect(page, ".vpl-notices li").not_to_have_count(0)
    page.locator(".vpl-row .vpl-remove").first.click()
    expect(page, ".vpl-notices").to_contain_text("make the text new first")
    before = page.evaluate(ROWS)
    page.locator("[data-answer=new]").click()
    page.wait_for_function(f"(before) => ({ROWS})() === before - 1", arg=before)
    expect(page, ".vpl-notices > *").to_have_count(0)

    page.set_input_files(
        "#editor-file",
        {"name": "class.json", "mimeType": "application/json", "buffer": b'{"toolbox": 1, "hide": ["sound", "clap"]}'},
    )
    expect(page, "[data-new-block=clap]").to_have_count(0)
    expect(page, "[data-new-block=button]").to_have_count(1)
    choose_in_file_menu(page, "all-blocks")
    expect(page, "[data-new-block=clap]").to_have_count(1)
