"""Programs of blocks in a real Chromium against the running suite: built, run, mended, opened, in both looks."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.web_ui.page_support import (
    KEY_MS,
    MARKS,
    choose_in_file_menu,
    choose_language,
    drop_file,
    open_menu,
    open_page,
    open_tab,
    step_into_event,
    wait_for_service,
    watch_it_avoid,
)

pytestmark = MARKS

AXE = Path(__file__).parents[2] / "web_ui/node_modules/axe-core/axe.min.js"
FINDINGS = """async () => (await axe.run(".program")).violations
    .map(({ id, nodes }) => `${id}: ${nodes.slice(0, 3).map(({ html }) => html.slice(0, 120)).join(" ")}`)"""
BLOCKS = ".blocklySvg .blocklyBlockCanvas"
CODE = ".program-code"
VERDICT = ".blocks-verdict"
FLYOUT = ".blocklyFlyout:visible"


PROJECT = {
    "targets": [
        {
            "isStage": False,
            "blocks": {
                "hat": {"opcode": "event_whenflagclicked", "next": "say", "topLevel": True, "inputs": {}, "fields": {}},
                "say": {"opcode": "looks_sayforsecs", "next": "stop", "parent": "hat", "inputs": {}, "fields": {}},
                "stop": {"opcode": "thymio_stopMotors", "next": None, "parent": "say", "inputs": {}, "fields": {}},
            },
        }
    ]
}


def expect(page, selector, **options):
    return playwright.expect(page.locator(selector, **options))


def begin(page, sample: str) -> None:
    """Begin with a sample."""
    open_tab(page, "program")
    page.locator(".program[data-shown=start], .program[data-shown=program]").wait_for()
    if not page.locator(f"[data-new={sample}]").is_visible():
        if page.locator("[data-samples=blocks] .program-more").is_visible():
            page.locator("[data-samples=blocks] .program-more summary").click()
        else:
            choose_in_file_menu(page, "new")
    page.click(f"[data-new={sample}]")
    page.locator(".blocks .blocklySvg").first.wait_for()


def next_frame(page) -> None:
    """Let Blockly draw and record what has happened, as it does before the next frame; no hand is quicker."""
    page.evaluate("() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


def show_text(page) -> None:
    if page.locator("[data-verb=text]").get_attribute("aria-pressed") == "false":
        page.click("[data-verb=text]")
    page.locator(CODE).wait_for()


def category(page, name: str):
    return page.locator(".blocklyToolboxCategory", has_text=name).first


def grip_of(page, block) -> tuple[float, float]:
    """A place at the left edge of a block, where it has no field, below the curve of a hat."""
    box = block.bounding_box()
    return box["x"] + 4, box["y"] + 20


def new_block(page, group: str, kind: str) -> tuple[float, float]:
    """Open a category; the place of a new block in it."""
    category(page, group).click()
    block = page.locator(f"{FLYOUT} .{kind}").first
    block.wait_for()
    next_frame(page)
    return grip_of(page, block)


def drag(page, start: tuple[float, float], end: tuple[float, float]) -> None:
    page.mouse.move(*start)
    page.mouse.down()
    page.mouse.move(start[0] + 8, start[1] + 8, steps=3)
    page.mouse.move(*end, steps=12)
    next_frame(page)
    page.mouse.up()
    next_frame(page)  # blocks are moved apart in it


def add(page, group: str, kind: str, target: tuple[float, float]) -> None:
    """Drag a new block to a place."""
    before = page.locator(f"{BLOCKS} .{kind}").count()
    drag(page, new_block(page, group, kind), target)
    expect(page, f"{BLOCKS} .{kind}").to_have_count(before + 1)


def below(page, kind: str, x: float, y: float) -> tuple[float, float]:
    """A place at a distance from the corner of the newest block of a kind."""
    box = page.locator(f"{BLOCKS} .{kind}").last.bounding_box()
    return box["x"] + x, box["y"] + y


def choose(page, kind: str, field: int, option: str) -> None:
    """Choose an option in a list of the newest block of a kind."""
    page.locator(f"{BLOCKS} .{kind}").last.locator(".blocklyDropdownField").nth(field).click()
    page.locator(".blocklyDropDownDiv .blocklyMenuItem").get_by_text(option, exact=True).click()
    page.locator(".blocklyDropDownDiv .blocklyMenuItem").first.wait_for(state="hidden")


@pytest.fixture
def blocks(world, page):
    """The tab of a robot at rest."""
    page.set_viewport_size({"width": 1280, "height": 800})
    open_page(page, world("base"))
    open_tab(page, "program")
    wait_for_service(page, "/aseba_runtime/check", "/aseba/step_line")
    return page


def test_a_program_that_avoids_is_built_by_mouse_mended_and_run_in_both_looks(blocks, world):
    page = blocks
    begin(page, "blocks-empty")
    expect(page, ".blocks-hint").to_be_visible()
    canvas = page.locator(".blocks-place").bounding_box()
    drag(page, new_block(page, "Motors", "thymio_motors_start"), (canvas["x"] + 320, canvas["y"] + 80))
    expect(page, f"{BLOCKS} .thymio_motors_start").to_have_count(1)
    expect(page, ".blocks-hint").to_be_hidden()
    show_text(page)
    expect(page, CODE).to_contain_text("motor.right.target = 300")
    expect(page, VERDICT).to_have_text("No mistakes")
    expect(page, f"{CODE} [data-mark=selected]").to_have_count(2)

    page.click("[data-verb=undo]")
    expect(page, f"{BLOCKS} .thymio_motors_start").to_have_count(0)
    expect(page, ".blocks-hint").to_be_visible()
    page.click("[data-verb=redo]")
    expect(page, f"{BLOCKS} .thymio_motors_start").to_have_count(1)

    # a mistake is shown at its block, and the file keeps the last program without one
    field = page.locator(f"{BLOCKS} .blocklyShadow .blocklyField")
    height = field.locator(".blocklyFieldRect").bounding_box()["height"]
    field.click()
    assert page.locator(".blocklyHtmlInput").bounding_box()["height"] < height + 2
    page.keyboard.type("99999\n", delay=KEY_MS)
    expect(page, VERDICT).to_contain_text("1 mistake: The number is 99999")
    playwright.expect(page.get_by_role("button", name="Run program")).to_be_disabled()
    expect(page, f"{BLOCKS} .blocklyWarningIcon, {BLOCKS} .blocklyIconGroup").to_have_count(1)
    page.click(VERDICT)
    expect(page, ".blocklyBubble").to_contain_text("from -32768 to 32767")
    expect(page, CODE).not_to_contain_text("99999")
    page.click("[data-verb=undo]")
    expect(page, VERDICT).to_have_text("No mistakes")

    if AXE.exists():
        page.add_script_tag(content=AXE.read_text(encoding="utf-8"))
        assert page.evaluate(FINDINGS) == []
        new_block(page, "Motors", "thymio_motors_start")  # the list of new blocks is open
        assert page.evaluate(FINDINGS) == []

    # drive while nothing is at the left, turn when something is ahead; then the same in the look of Scratch
    far = (canvas["x"] + 320, canvas["y"] + 180)
    add(page, "Events", "thymio_event_prox", far)
    choose(page, "thymio_event_prox", 1, "nothing")
    drag(page, grip_of(page, page.locator(f"{BLOCKS} .thymio_motors_start")), below(page, "thymio_event_prox", 30, 40))
    add(page, "Events", "thymio_event_prox", (far[0], far[1] + 120))
    choose(page, "thymio_event_prox", 0, "front middle")
    add(page, "Motors", "thymio_motors_start", below(page, "thymio_event_prox", 30, 40))
    choose(page, "thymio_motors_start", 0, "turning right on the spot")
    expect(page, VERDICT).to_have_text("No mistakes")
    page.click("[data-verb=run]")
    watch_it_avoid(page, world)
    expect(page, "#program-state").to_have_text("running")

    begin(page, "blocks-scratch_start")
    add(page, "Events", "thymio_touching", far)
    add(page, "Motion", "thymio_setMotor", below(page, "thymio_touching", 4, 46))
    choose(page, "thymio_setMotor", 0, "right")
    page.locator(f"{BLOCKS} .thymio_setMotor .blocklyShadow .blocklyField").click()
    page.keyboard.type("-50\n", delay=KEY_MS)
    add(page, "Events", "thymio_notouching", (far[0], far[1] + 140))
    add(page, "Motion", "thymio_setMotor", below(page, "thymio_notouching", 4, 46))
    expect(page, VERDICT).to_have_text("No mistakes")
    page.click("[data-verb=run]")
    watch_it_avoid(page, world)


@pytest.mark.slow
def test_blocks_are_put_together_by_keys_and_run_one_by_one(blocks):
    page = blocks
    begin(page, "blocks-empty")
    area = page.locator(".blocks-place").bounding_box()
    page.mouse.click(area["x"] + 400, area["y"] + 200)
    page.keyboard.press("t")
    page.locator(".blocklyToolboxCategoryContainer:focus").wait_for()
    page.keyboard.press("ArrowDown")
    page.locator(f"{FLYOUT} .thymio_motors_start").wait_for()
    page.keyboard.press("ArrowRight")
    page.locator(f"{FLYOUT} .thymio_motors_start:focus, {FLYOUT} .thymio_motors_start :focus").wait_for()
    page.keyboard.press("Enter")  # takes it
    next_frame(page)
    page.keyboard.press("Enter")  # puts it down
    expect(page, f"{BLOCKS} .thymio_motors_start").to_have_count(1)
    expect(page, "[data-verb=undo]").to_be_enabled()
    next_frame(page)
    page.keyboard.press("Delete")
    expect(page, f"{BLOCKS} .thymio_motors_start").to_have_count(0)
    next_frame(page)
    page.keyboard.press("Control+z")
    expect(page, f"{BLOCKS} .thymio_motors_start").to_have_count(1)

    begin(page, "blocks-avoid")
    expect(page, f"{BLOCKS} .thymio_event_update").to_have_count(1)
    show_text(page)
    page.keyboard.press("F9")
    expect(page, "#program-state").to_have_text("running")
    page.keyboard.press("F10")
    expect(page, "#program-state").to_contain_text("halted")
    step_into_event(page, f"{BLOCKS} .blocklyHighlighted")  # while it waits for an event it is in no line
    expect(page, f"{BLOCKS} .blocklyHighlighted").to_have_count(1)
    expect(page, f"{CODE} [data-mark=running]").to_have_count(1)
    page.keyboard.press("F7")
    expect(page, f"{BLOCKS} .blocklyHighlighted").to_have_count(1)
    page.keyboard.press("F9")
    expect(page, f"{BLOCKS} .blocklyHighlighted").to_have_count(0)


@pytest.mark.slow
def test_files_open_change_and_keep_what_is_theirs(blocks, tmp_path):
    page = blocks
    # a text that was edited runs until the user decides
    begin(page, "blocks-line")
    expect(page, VERDICT).to_have_text("No mistakes")
    show_text(page)
    with page.expect_download() as download:
        page.keyboard.press("Control+s")
    saved = tmp_path / "edited.aesl"
    text = Path(download.value.path()).read_text(encoding="utf-8")
    assert "<ThymioBlockly>" in text
    saved.write_text(text.replace("= 200", "= 222", 1), encoding="utf-8")
    drop_file(page, saved, ".blocks-place")
    expect(page, ".blocks-notice").to_contain_text("another one")
    expect(page, CODE).to_contain_text("= 222")
    page.locator(f"{BLOCKS} .thymio_led").click(position={"x": 6, "y": 8})
    page.keyboard.press("Delete")
    page.get_by_role("button", name="Take the change back").click()
    expect(page, f"{BLOCKS} .thymio_led").to_have_count(1)
    page.click("[data-notice=adopt]")
    expect(page, ".blocks-notice").to_be_hidden()
    expect(page, CODE).not_to_contain_text("= 222")

    # blocks leave the file, and come back
    page.click("[data-verb=turn]")
    expect(page, ".cm-content").to_contain_text("onevent prox")
    page.click("[data-detach=undo]")
    expect(page, f"{BLOCKS} .thymio_event_update").to_have_count(1)

    # a project of Scratch, with what the robot cannot do
    project = tmp_path / "project.sb3"
    with zipfile.ZipFile(project, "w") as archive:
        archive.writestr("project.json", json.dumps(PROJECT))
    drop_file(page, project, ".blocks-place")
    expect(page, f"{BLOCKS} .thymio_stopMotors").to_have_count(1)
    expect(page, ".scratch-renderer, .zelos-renderer").to_have_count(1)
    expect(page, ".blocks-notice").to_contain_text("left out")
    page.click(".blocks-notice summary")
    expect(page, ".blocks-notice li").to_have_text("left out: looks_sayforsecs (1 times)")

    # a teacher's file hides blocks
    limits = tmp_path / "limits.json"
    limits.write_text('{"toolbox": 1, "hide": ["category:motion"], "modes": ["scratch"]}')
    drop_file(page, limits, ".blocks-place")
    expect(page, ".blocklyToolboxCategory", has_text="Motion").to_have_count(0)
    choose_in_file_menu(page, "all-blocks")
    expect(page, ".blocklyToolboxCategory", has_text="Motion").to_have_count(1)

    # the other look, and another language: the program stays
    open_menu(page, "#file-menu")
    page.click("[data-look=blockly]")
    expect(page, ".blocklyToolboxCategory", has_text="Loops").to_have_count(1)
    expect(page, f"{BLOCKS} .thymio_stopMotors").to_have_count(1)
    page.keyboard.press("Escape")
    choose_language(page, "de")
    expect(page, ".blocklyToolboxCategory", has_text="Schleifen").to_have_count(1)
    expect(page, f"{BLOCKS} .thymio_stopMotors").to_have_count(1)
