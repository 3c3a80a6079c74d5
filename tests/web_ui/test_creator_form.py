"""The form of the playground creator: numbers, names, points, pictures, shortcuts; what fits where."""

from __future__ import annotations

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.web_ui.creator_support import (
    built,
    click,
    items,
    open_creator,
    open_details,
    spot,
    wait_for_items,
)
from tests.web_ui.page_support import (
    MARKS,
    choose_language,
    wait_for_frame,
    wait_for_none,
)
from tests.web_ui.test_page_access import AXE, FINDINGS

pytestmark = MARKS

CONTROLS = (
    ".palette button, .creator-tools button, .creator-bar > * > button, #creator-try, #creator-more, header button"
)
OUT_OF_SIGHT = """(controls) => [...document.querySelectorAll(controls)]
    .filter((one) => one.checkVisibility()).filter((one) => {
        const {left, top, right, bottom} = one.getBoundingClientRect();
        const hit = document.elementFromPoint((left + right) / 2, (top + bottom) / 2);
        return left < 0 || top < 0 || right > innerWidth || bottom > innerHeight || !one.contains(hit);
    }).map((one) => one.outerHTML.slice(0, 120))"""


def test_items_are_dragged_turned_and_edited_as_numbers(at_rest, page):
    open_creator(page, at_rest)
    page.click("[data-tool=box]")
    click(page, 0.3, 0.2)
    page.keyboard.press("Escape")
    page.mouse.move(*spot(page, 0.3, 0.2, 0.05))
    page.mouse.down()
    page.mouse.move(*spot(page, 0.2, 0.1, 0.05), steps=4)
    page.mouse.move(*spot(page, -0.2, 0.2, 0.05), steps=4)
    page.mouse.up()
    page.wait_for_function("window.thymio.built().playground.items[1].x_m === -0.2")
    page.wait_for_function("window.thymio.built().selected === 'box_1'")
    ring = 0.05 * 2**0.5 + 0.03
    page.mouse.move(*spot(page, -0.2 + ring, 0.2))
    page.mouse.down()
    page.mouse.move(*spot(page, -0.2, 0.2 + ring), steps=6)
    page.mouse.up()
    page.wait_for_function("Math.abs(window.thymio.built().playground.items[1].yaw_rad - Math.PI / 2) < 0.001")
    height = page.locator(".item-form [data-field=height_m]")
    height.fill("0.05")
    height.press("Enter")
    playwright.expect(page.locator(".item-form .problem:visible")).to_have_text("from 0.1 to 10000 cm")
    height.fill("0.5")
    height.press("Enter")
    page.wait_for_function("window.thymio.built().playground.items[1].height_m === 0.005")
    page.locator("[data-field=movable]").check()
    page.wait_for_function("window.thymio.built().playground.items[1].mass_kg === 0.1")
    open_details(page)
    name = page.locator(".item-form [data-field=name]")
    name.fill("z")
    name.press("Control+z")
    name.press("Delete")
    assert len(items(page)) == 3, "keys in a field act on the field only"


TYPED_AFTER_A_CHANGE = """(input) => {
    input.value = "-30";
    input.dispatchEvent(new Event("change"));
    input.value = "-20";
}"""


@pytest.mark.slow
def test_what_is_typed_after_a_change_stays_and_is_taken_with_the_next_one(at_rest, page):
    open_creator(page, at_rest)
    page.locator("[data-tool=box]").click()
    click(page, -0.4, 0.3)
    page.keyboard.press("Escape")
    click(page, -0.4, 0.3)
    open_details(page)
    field = page.locator("[data-field=x_m]")
    field.evaluate(TYPED_AFTER_A_CHANGE)
    wait_for_frame(page)
    assert field.input_value() == "-20"
    field.dispatch_event("change")
    page.wait_for_function("window.thymio.built().playground.items.some((one) => one.x_m === -0.2)")
    undo = page.get_by_role("button", name="Undo")
    undo.click()
    playwright.expect(field).to_have_value("-30")
    field.press("ArrowUp")
    page.wait_for_function("window.thymio.built().playground.items.every((one) => one.x_m !== -0.3)")
    undo.click()
    playwright.expect(field).to_have_value("-30")


@pytest.mark.slow
def test_tab_moves_on_in_the_form_after_a_name_or_a_point_was_changed(at_rest, page):
    open_creator(page, at_rest)
    page.click("[data-tool=track]")
    for key in ("Space", "ArrowUp", "ArrowUp", "Space", "Enter", "Escape"):
        page.keyboard.press(key)
    page.click(".item-list summary")
    page.click("[data-item=track_1]")
    open_details(page)
    name = page.get_by_label("Name")
    name.fill("lane")
    page.keyboard.press("Tab")
    page.wait_for_function("() => window.thymio.built().selected === 'lane'")
    wait_for_frame(page)
    assert page.evaluate("() => document.activeElement.closest('.item-form') !== null")
    page.click(".field-points summary")
    x, y = page.locator(".field-points input").nth(0), page.locator(".field-points input").nth(1)
    x.fill("7")
    page.keyboard.press("Tab")
    page.wait_for_function("() => window.thymio.built().playground.items.some((i) => i.points_m?.[0][0] === 0.07)")
    playwright.expect(y).to_be_focused()


@pytest.mark.slow
def test_a_file_that_is_not_an_image_is_rejected_at_its_field(at_rest, page, tmp_path):
    open_creator(page, at_rest)
    good, bad = tmp_path / "good.svg", tmp_path / "bad.png"
    good.write_text('<svg xmlns="http://www.w3.org/2000/svg" width="8" height="8"/>')
    bad.write_text("no picture")
    page.set_input_files("#creator-picture", str(good))
    page.wait_for_function("() => window.thymio.built().placing?.kind === 'picture'")
    page.set_input_files(".item-form input[data-field=image]", str(bad))
    playwright.expect(page.locator(".item-form .problem:visible")).to_have_text(
        "bad.png is not a picture that can be read"
    )


@pytest.mark.slow
def test_what_can_be_pushed_is_said_in_a_sentence(at_rest, page):
    open_creator(page, at_rest)
    page.click("[data-tool=box]")
    click(page, 0.3, 0.2)
    page.keyboard.press("Escape")
    click(page, 0.3, 0.2, 0.05)
    movable = page.locator(".movable")
    playwright.expect(movable).to_contain_text("It stays where it is.")
    page.get_by_role("switch", name="Can be pushed").check()
    playwright.expect(movable).to_contain_text("100 g, slides easily")
    open_details(page)
    for key, value in (("mass_kg", "80"), ("friction", "0.5")):
        page.locator(f".item-form [data-field={key}]").fill(value)
        page.locator(f".item-form [data-field={key}]").press("Enter")
    playwright.expect(movable).to_contain_text("80 g, slides on paper")


@pytest.mark.slow
def test_mac_shortcuts_undo_redo_and_copy(at_rest, page):
    open_creator(page, at_rest)
    page.click("[data-tool=box]")
    click(page, 0.3, 0.2)
    wait_for_items(page, 3)
    page.keyboard.press("Escape")
    for keys, count in (("Meta+z", 2), ("Meta+Shift+z", 3), ("Meta+z", 2), ("Meta+y", 3)):
        page.keyboard.press(keys)
        wait_for_items(page, count)
    page.keyboard.press("n")
    page.keyboard.press("n")
    assert built(page)["selected"] == "box_1"
    page.keyboard.press("Meta+d")
    wait_for_items(page, 4)


@pytest.mark.slow
def test_it_fits_800_by_600_in_every_language_without_a_finding_of_axe(at_rest, page):
    page.set_viewport_size({"width": 800, "height": 600})
    open_creator(page, at_rest)
    for language in ("de", "fr", "it", "en"):
        choose_language(page, language)
        wait_for_frame(page)
        wait_for_none(page, OUT_OF_SIGHT, CONTROLS)
    if not AXE.exists():
        return
    page.add_script_tag(path=str(AXE))
    assert page.evaluate(FINDINGS) == []
    page.click("[data-tool=box]")
    click(page, 0.3, 0.2)
    page.keyboard.press("Escape")
    page.keyboard.press("n")
    playwright.expect(page.locator(".item-form [data-field=size_x_m]")).to_be_visible()
    open_details(page)
    page.locator(".item-list summary").click()
    assert page.evaluate(FINDINGS) == []


@pytest.mark.slow
def test_bends_without_room_are_a_warning_until_they_have_it(at_rest, page):
    open_creator(page, at_rest)
    page.click("[data-tool=track]")
    for x, y in ((-0.4, -0.4), (0.4, -0.4), (0.4, 0.1)):
        click(page, x, y)
    page.keyboard.press("Enter")
    page.keyboard.press("Escape")
    wait_for_items(page, 3)
    click(page, 0.0, -0.4)
    open_details(page)
    radius = page.locator("[data-field=corner_radius_m]")
    for value, text in (("1", " must be 0 or at least half of the width"), ("60", ": the bends have no room")):
        radius.fill(value)
        radius.press("Enter")
        playwright.expect(page.locator(".creator .note-box:visible")).to_contain_text(
            f"track_1: Roundness of the bends{text}"
        )
    radius.fill("20")
    radius.press("Enter")
    playwright.expect(page.locator(".creator .note-box:visible")).to_have_count(0)
