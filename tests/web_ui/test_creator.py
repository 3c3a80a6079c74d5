"""The playground creator in a real browser: pointer, keys and touch; draft, save, open, try."""

from __future__ import annotations

import json
import math
import os

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests import plugin_page
from tests.web_ui.conftest import DEADLINE_MS, LOCAL
from tests.web_ui.page_support import (
    MARKS,
    TouchPoints,
    build_playground,
    choose_example,
    choose_language,
    go_on_building,
    open_editor,
    open_menu,
    open_page,
    open_tab,
    wait_for_frame,
    wait_until_still,
)
from tests.web_ui.test_page_access import AXE, FINDINGS
from thymio_sim_ros.sim.playground import reader as playgrounds

pytestmark = MARKS

ONE_LOOP = """() => {
    window.drawn = {most: 0};
    const request = window.requestAnimationFrame.bind(window);
    let frame = -1, count = 0;
    window.requestAnimationFrame = (callback) => request((now) => {
        count = now === frame ? count + 1 : 1;
        frame = now;
        window.drawn.most = Math.max(window.drawn.most, count);
        callback(now);
    });
}"""
MOVES = """async (moves) => {
    const canvas = document.querySelector("#view");
    const {left, top, width, height} = canvas.getBoundingClientRect();
    for (let move = 0; move < moves; move++) {
        const clientX = left + width * (0.3 + 0.4 * ((move * 7) % 100) / 100);
        const clientY = top + height * (0.3 + 0.4 * ((move * 13) % 100) / 100);
        canvas.dispatchEvent(new PointerEvent("pointermove", {clientX, clientY, pointerId: 1, bubbles: true}));
        if (move % 500 === 0) await new Promise((settle) => setTimeout(settle));
    }
}"""
CONTROLS = (
    ".palette button, .creator-tools button, .creator-bar > * > button, #creator-try, #creator-more, header button"
)
OVER = """(bar, {x, y}) => {
    const {left, right, bottom} = bar.getBoundingClientRect();
    return left < x && x < right && bottom < y && y - bottom < 120;
}"""
IN_SIGHT = """(one) => {
    const {left, top, right, bottom} = one.getBoundingClientRect();
    return one.contains(document.elementFromPoint((left + right) / 2, (top + bottom) / 2));
}"""
OUT_OF_SIGHT = """(controls) => [...document.querySelectorAll(controls)]
    .filter((one) => one.checkVisibility()).filter((one) => {
        const {left, top, right, bottom} = one.getBoundingClientRect();
        const hit = document.elementFromPoint((left + right) / 2, (top + bottom) / 2);
        return left < 0 || top < 0 || right > innerWidth || bottom > innerHeight || !one.contains(hit);
    }).map((one) => one.outerHTML.slice(0, 120))"""


def open_creator(page, suite, *arguments):
    open_page(page, suite("--playground", "base", "--program", "none", *arguments))
    build_playground(page)
    wait_for_camera(page)


def choose_more(page, verb):
    """Choose an entry of the menu "More"."""
    open_menu(page, "#creator-more")
    page.click(f"#creator-menu [data-verb={verb}]")


def open_details(page):
    """Unfold the other values of the item."""
    details = page.locator(".item-details")
    if details.get_attribute("open") is None:
        details.locator("summary").first.click()


def wait_for_camera(page):
    """Wait until the camera is still."""
    wait_until_still(page, "window.thymio.screenPosition(0.1, 0.1, 0)")


def built(page):
    return page.evaluate("window.thymio.built()")


def items(page):
    return {item["name"]: item for item in built(page)["playground"]["items"]}


def spot(page, x, y, z=0.0):
    place = page.evaluate("([x, y, z]) => window.thymio.screenPosition(x, y, z)", [x, y, z])
    return place["x"], place["y"]


def click(page, x, y, z=0.0):
    page.mouse.click(*spot(page, x, y, z))


def wait_for_items(page, count):
    page.wait_for_function("(count) => window.thymio.built().playground.items.length === count", arg=count)


def test_a_playground_is_built_with_undo_saved_restored_opened_and_tried(suite, page, tmp_path):
    open_creator(page, suite)
    page.click("[data-tool=box]")
    click(page, 0.3, 0.3)
    click(page, 0.3, -0.3)
    wait_for_items(page, 4)
    page.keyboard.press("Control+z")
    wait_for_items(page, 3)
    page.keyboard.press("Control+z")
    page.keyboard.press("Control+y")
    page.keyboard.press("Control+Shift+Z")
    wait_for_items(page, 4)
    page.keyboard.press("Control+z")
    page.click("[data-tool=track]")
    for x, y in ((-0.4, -0.4), (0.4, -0.4), (0.4, 0.1)):
        click(page, x, y)
    page.click(".finish")
    wait_for_items(page, 4)
    assert items(page)["track_1"]["points_m"] == [[-0.4, -0.4], [0.4, -0.4], [0.4, 0.1]]
    page.keyboard.press("Escape")
    page.locator("[data-field=title]").fill("A way out")
    page.locator("[data-field=title]").press("Enter")
    with page.expect_download() as saving:
        choose_more(page, "save")
    assert saving.value.suggested_filename == "A_way_out.json"
    saved = tmp_path / "A_way_out.json"
    saving.value.save_as(saved)
    loaded = playgrounds.load(saved)
    assert [shape.name for shape in loaded.shapes] == ["ground", "box_1", "track_1"]

    page.reload()
    page.wait_for_function("window.thymio && window.thymio.connected")
    go_on_building(page, "A way out")
    page.wait_for_function("window.thymio.built()?.playground.title === 'A way out'")
    choose_more(page, "new")
    wait_for_items(page, 2)
    page.set_input_files("#creator-file", str(saved))
    wait_for_items(page, 4)
    page.click("#creator-try")
    page.wait_for_function("window.thymio.state().simulator?.title === 'A way out'")
    page.wait_for_function("!window.thymio.built().isOpen")
    page.wait_for_function("window.thymio.state().robot?.latest")
    page.locator("#view").focus()
    page.keyboard.press("t")
    start = page.evaluate("window.thymio.state().robot.latest.pose")
    choose_example(page, "thesis_basic")
    page.wait_for_function(
        "window.thymio.state().program?.state === 'running' && window.thymio.state().program.name.includes('basic')"
    )
    page.locator("[data-button=forward]").hover()
    page.mouse.down()
    page.wait_for_function(
        "(start) => { const {x, y} = window.thymio.state().robot.latest.pose;"
        " return Math.hypot(x - start.x, y - start.y) > 0.03; }",
        arg=start,
    )


def test_everything_is_built_by_keys_alone(suite, page):
    open_page(page, suite("--playground", "base", "--program", "none"))
    page.locator("#tab-playground").press("Enter")
    page.locator(".current [data-new]").press("Enter")
    page.locator("[data-tool=box]").press("Enter")
    assert page.evaluate("document.activeElement.id") == "view"
    for key in ("Shift+ArrowRight", "ArrowUp", ".", "Enter"):
        page.keyboard.press(key)
    page.keyboard.press("Escape")
    wait_for_items(page, 3)
    box = items(page)["box_1"]
    assert (box["x_m"], box["y_m"]) == (0.4, 0.05)
    assert box["yaw_rad"] == pytest.approx(-0.2618, abs=1e-3)
    page.locator("[data-tool=track]").press("Enter")
    for key in ("Shift+ArrowDown", " ", "Shift+ArrowRight", " ", "ArrowUp", " ", "Backspace", "Enter", "Escape"):
        page.keyboard.press(key)
    wait_for_items(page, 4)
    assert items(page)["track_1"]["points_m"] == [[0, -0.25], [0.25, -0.25]]
    page.keyboard.press("n")
    page.keyboard.press("n")
    assert built(page)["selected"] == "box_1"
    page.keyboard.press("Alt+ArrowLeft")
    assert items(page)["box_1"]["x_m"] == 0.399
    page.keyboard.press("Control+d")
    wait_for_items(page, 5)
    page.keyboard.press("Delete")
    wait_for_items(page, 4)
    page.keyboard.press("n")
    page.keyboard.press("n")
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.dataset.field") == "size_x_m"
    width = page.locator(".item-form [data-field=size_x_m]")
    width.fill("12.5")
    width.press("Enter")
    page.wait_for_function("window.thymio.built().playground.items.some(({size_x_m}) => size_x_m === 0.125)")
    page.locator("#view").focus()
    page.keyboard.press("Escape")
    assert built(page)["selected"] is None
    page.locator("#creator-try").press("Enter")
    page.wait_for_function("window.thymio.state().simulator.playground === 'My_playground.json'")


def test_the_ghost_is_red_at_invalid_positions_and_the_reason_is_shown(suite, page):
    open_creator(page, suite)
    page.click("[data-tool=cylinder]")
    page.mouse.move(*spot(page, 0.0, 0.0))
    page.wait_for_function("window.thymio.built().problem === 'problem.blocked'")
    playwright.expect(page.locator(".placing-hint")).to_have_text("thymio is in the way")
    click(page, 0.0, 0.0)
    page.mouse.move(*spot(page, 0.3, 0.2))
    page.wait_for_function("window.thymio.built().problem === null")
    assert len(items(page)) == 2


def test_items_are_dragged_turned_and_edited_as_numbers(suite, page):
    open_creator(page, suite)
    page.click("[data-tool=box]")
    click(page, 0.3, 0.2)
    page.keyboard.press("Escape")
    page.mouse.move(*spot(page, 0.3, 0.2, 0.05))
    page.mouse.down()
    page.mouse.move(*spot(page, 0.2, 0.1, 0.05), steps=4)
    page.mouse.move(*spot(page, -0.2, 0.2, 0.05), steps=4)
    page.mouse.up()
    page.wait_for_function("window.thymio.built().playground.items[1].x_m === -0.2")
    assert built(page)["selected"] == "box_1"
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


def test_tab_moves_on_in_the_form_after_a_name_or_a_point_was_changed(suite, page):
    open_creator(page, suite)
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


def test_a_file_that_is_not_an_image_is_rejected_at_its_field(suite, page, tmp_path):
    open_creator(page, suite)
    good, bad = tmp_path / "good.svg", tmp_path / "bad.png"
    good.write_text('<svg xmlns="http://www.w3.org/2000/svg" width="8" height="8"/>')
    bad.write_text("no picture")
    page.set_input_files("#creator-picture", str(good))
    page.wait_for_function("() => window.thymio.built().placing?.kind === 'picture'")
    page.set_input_files(".item-form input[data-field=image]", str(bad))
    playwright.expect(page.locator(".item-form .problem:visible")).to_have_text(
        "bad.png is not a picture that can be read"
    )


def test_mac_shortcuts_undo_redo_and_copy(suite, page):
    open_creator(page, suite)
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


def test_positions_snap_to_the_grid_unless_alt_is_held_and_the_wheel_turns_the_ghost(suite, page):
    open_creator(page, suite)
    page.click("[data-tool=box]")
    click(page, 0.313, 0.207)
    wait_for_items(page, 3)
    page.mouse.move(*spot(page, -0.3, 0.2))
    page.wait_for_function("Math.abs(window.thymio.built().placing.place[0] + 0.3) < 0.01")
    page.mouse.wheel(0, 120)
    playwright.expect(page.locator(".creator-bar .status")).to_contain_text("-15°")
    page.keyboard.down("Alt")
    click(page, -0.313, 0.207)
    page.keyboard.up("Alt")
    wait_for_items(page, 4)
    placed = items(page)
    assert (placed["box_1"]["x_m"], placed["box_1"]["y_m"], placed["box_1"].get("yaw_rad", 0)) == (0.3, 0.2, 0)
    assert placed["box_2"]["x_m"] == pytest.approx(-0.313, abs=0.003)
    assert placed["box_2"]["y_m"] == pytest.approx(0.207, abs=0.003)
    assert placed["box_2"]["x_m"] != -0.3
    assert placed["box_2"]["yaw_rad"] == pytest.approx(-math.radians(15), abs=1e-3)


def test_shift_toggles_the_camera_and_clicks_place_items_either_way(suite, page):
    open_creator(page, suite)
    page.click("[data-tool=cylinder]")
    page.keyboard.press("Shift")
    assert built(page)["cameraOn"] is False
    before = built(page)["camera"]
    drag(page)
    click(page, 0.3, 0.2)
    wait_for_items(page, 3)
    assert built(page)["camera"] == before
    page.keyboard.press("Shift")
    playwright.expect(page.locator("[data-verb=camera]")).to_have_attribute("aria-pressed", "true")  # with a frame
    drag(page)
    page.wait_for_function("(before) => window.thymio.built().camera[0] !== before[0]", arg=before)
    assert len(items(page)) == 3, "a drag places nothing"


def drag(page):
    x, y = spot(page, -0.3, -0.2)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 60, y + 10, steps=5)
    page.mouse.up()


def test_ten_thousand_moves_leave_one_animation_loop(suite, page):
    page.add_init_script(f"({ONE_LOOP})()")
    open_creator(page, suite)
    page.click("[data-tool=u_figure]")
    page.evaluate(MOVES, 10_000)
    frames = page.evaluate("window.thymio.frames()")
    page.evaluate("window.drawn.most = 0")
    page.wait_for_function("(frames) => window.thymio.frames() > frames + 3", arg=frames, polling=100)
    assert page.evaluate("window.drawn.most") == 1
    assert frames < 2_000, "moves do not draw, frames do"


def test_it_fits_800_by_600_in_every_language_without_a_finding_of_axe(suite, page):
    page.set_viewport_size({"width": 800, "height": 600})
    open_creator(page, suite)
    for language in ("de", "fr", "it", "en"):
        choose_language(page, language)
        wait_for_frame(page)
        assert page.evaluate(OUT_OF_SIGHT, CONTROLS) == []
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


def test_items_are_placed_and_dragged_by_touch(suite, browser):
    page = browser.new_page(viewport={"width": 1024, "height": 768}, bypass_csp=True, has_touch=True)
    page.set_default_timeout(DEADLINE_MS)
    page.on("request", lambda request: None if request.url.startswith(LOCAL) else pytest.fail(request.url))
    open_creator(page, suite)
    page.locator("[data-tool=robot]").tap()
    page.wait_for_function("window.thymio.built().placing?.kind === 'robot'")  # a tap becomes a click only later
    page.touchscreen.tap(*spot(page, 0.25, 0.2))
    wait_for_items(page, 3)
    assert items(page)["thymio_1"]["x_m"] == 0.25
    touches, corners = TouchPoints(page), ((0.4, 0.4), (-0.4, -0.4))
    before = math.dist(*(spot(page, *corner) for corner in corners))
    camera = built(page)["camera"]
    touches.start(a=(380, 280), b=(420, 320))
    touches.move(a=(320, 220), b=(480, 380))
    touches.end()
    page.wait_for_function("(camera) => window.thymio.built().camera[0] !== camera[0]", arg=camera)
    wait_for_camera(page)
    assert math.dist(*(spot(page, *corner) for corner in corners)) > 1.2 * before
    assert len(items(page)) == 3, "two fingers move the camera and place nothing"
    page.locator(".cancel").tap()
    page.wait_for_function("window.thymio.built().placing === null")
    page.close()


def test_another_tab_shows_the_running_world_and_the_tab_of_playgrounds_continues(suite, page):
    open_creator(page, suite)
    open_editor(page)
    assert built(page)["isOpen"] is False
    open_tab(page, "playground")
    page.locator(".palette").wait_for()
    playwright.expect(page.locator(".editor")).to_be_hidden()


def test_an_image_is_placed_on_the_ground(suite, page, tmp_path):
    drawing = tmp_path / "drawing.svg"
    drawing.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 20 10"><circle r="5" cx="8" cy="5"/></svg>'
    )
    open_creator(page, suite)
    page.set_input_files("#creator-picture", str(drawing))
    page.wait_for_function("window.thymio.built().placing?.kind === 'picture'")
    click(page, 0.2, 0.2)
    wait_for_items(page, 3)
    page.click("#creator-try")
    page.wait_for_function("window.thymio.state().simulator.playground === 'My_playground.json'")


def test_the_head_says_where_the_playground_is_kept(suite, page):
    open_creator(page, suite)
    kept = page.locator(".creator .kept")
    playwright.expect(kept).to_have_text("Nothing to save yet")
    page.locator("[data-field=title]").fill("Kept")
    page.locator("[data-field=title]").press("Enter")
    playwright.expect(kept).to_have_text("Saved on this device")
    open_editor(page)
    page.focus(".cm-content")
    page.keyboard.insert_text("var a")
    playwright.expect(page.locator(".program-unsaved")).to_be_visible()
    open_tab(page, "playground")
    playwright.expect(kept).to_have_text("Saved on this device")
    with page.expect_download():
        choose_more(page, "save")
    playwright.expect(kept).to_have_text("Saved as a file")
    page.reload()
    page.wait_for_function("window.thymio && window.thymio.connected")
    go_on_building(page, "Kept")
    page.wait_for_function("window.thymio.built()?.playground.title === 'Kept'")
    playwright.expect(kept).to_have_text("Saved as a file")


def test_the_bar_over_the_selected_item_turns_copies_and_removes_it(suite, page):
    open_creator(page, suite)
    bar = page.locator(".context-bar")
    page.click("[data-tool=box]")
    click(page, 0.3, 0.2)
    wait_for_items(page, 3)
    playwright.expect(bar).to_be_hidden()
    page.keyboard.press("Escape")
    click(page, 0.3, 0.2, 0.05)
    playwright.expect(bar).to_be_visible()
    assert bar.evaluate(OVER, page.evaluate("window.thymio.screenPosition(0.3, 0.2, 0.1)"))
    bar.get_by_role("button", name="Turn").click()
    page.wait_for_function("Math.abs(window.thymio.built().playground.items[1].yaw_rad - Math.PI / 12) < 0.001")
    bar.get_by_role("button", name="Copy").click()
    wait_for_items(page, 4)
    assert built(page)["selected"] == "box_2"
    bar.get_by_role("button", name="Remove").click()
    wait_for_items(page, 3)
    playwright.expect(bar).to_be_hidden()
    assert page.evaluate("document.activeElement.id") == "view"


def test_what_things_snap_to_is_chosen_in_the_bar_below(suite, page):
    open_creator(page, suite)
    playwright.expect(page.locator("#creator-snap")).to_have_text("Snap to 5 cm")
    open_menu(page, "#creator-snap")
    page.get_by_role("radio", name="Do not snap").check()
    page.keyboard.press("Escape")
    playwright.expect(page.locator("#creator-snap")).to_have_text("Do not snap")
    page.click("[data-tool=box]")
    click(page, 0.313, 0.207)
    wait_for_items(page, 3)
    assert items(page)["box_1"]["x_m"] == pytest.approx(0.313, abs=0.003)
    assert items(page)["box_1"]["x_m"] != 0.3


def test_what_can_be_pushed_is_said_in_a_sentence(suite, page):
    open_creator(page, suite)
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


@pytest.mark.parametrize("size", [(390, 844), (1024, 768)])
def test_all_tools_are_reached_by_touch(suite, browser, size):
    page = browser.new_page(viewport={"width": size[0], "height": size[1]}, bypass_csp=True, has_touch=True)
    page.set_default_timeout(DEADLINE_MS)
    open_creator(page, suite)
    groups = page.locator(".tool-group")
    playwright.expect(groups.locator("h3")).to_have_text(["Ground", "Things", "Doors and robots"])
    for tool in ("rectangle", "octagon", "track", "box", "cylinder", "wall", "u_figure", "door", "robot"):
        button = page.locator(f"[data-tool={tool}]")
        button.scroll_into_view_if_needed()
        box = button.bounding_box()
        assert min(box["width"], box["height"]) >= 44
        button.tap()
        page.wait_for_function("(tool) => window.thymio.built().placing?.kind === tool", arg=tool)
        assert page.locator("#creator-try").evaluate(IN_SIGHT)
    page.locator("[data-tool=select]").tap()
    page.wait_for_function("window.thymio.built().placing === null")
    page.locator("[data-tool=activation]").tap()
    playwright.expect(page.locator("#live")).to_have_text("Add a door first. A plate needs one to open.")
    with page.expect_file_chooser():
        page.locator("[data-tool=picture]").tap()
    page.wait_for_function("() => document.documentElement.scrollWidth <= innerWidth")
    page.close()


def test_a_playground_with_a_door_is_built_in_twelve_clicks_by_names_only(suite, page):
    open_page(page, suite("--playground", "base", "--program", "none"))
    page.get_by_role("tab", name="Playground").click()
    page.get_by_role("button", name="New playground").click()
    page.get_by_role("button", name="Door", exact=True).click()
    wait_for_camera(page)
    click(page, -0.2, 0.2)
    page.get_by_role("button", name="Plate", exact=True).click()
    click(page, 0.3, -0.2)
    wait_for_items(page, 4)
    page.get_by_role("button", name="Try it").click()  # the seventh click
    page.wait_for_function("window.thymio.state().simulator.playground === 'My_playground.json'")
    assert page.evaluate("window.thymio.state().objects.length") > 0


def test_without_ground_the_creator_warns_and_offers_to_add_one(suite, page):
    open_creator(page, suite)
    add = page.get_by_role("button", name="Add a ground")
    playwright.expect(add).to_be_hidden()
    page.select_option("#creator-ground", "none")
    add.click()
    playwright.expect(add).to_be_hidden()
    page.wait_for_function("window.thymio.built().playground.items[0].kind === 'rectangle'")


def test_a_shape_of_a_plugin_is_placed_edited_and_saved_by_its_declaration_alone(suite, page, tmp_path, monkeypatch):
    installed = tmp_path / "site-packages"
    plugin_page.lay_out(installed, plugin_page.files())
    monkeypatch.setenv("PYTHONPATH", f"{installed}{os.pathsep}{os.environ.get('PYTHONPATH', '')}")
    open_creator(page, suite)
    tool = page.locator("[data-tool=slalom]")
    assert tool.get_attribute("title") == "Slalom posts"
    tool.click()
    click(page, -0.4, 0.3)
    wait_for_items(page, 3)
    page.keyboard.press("Escape")
    click(page, -0.4, 0.3, 0.05)
    page.locator("[data-field=gap_m]").fill("50")
    page.locator("[data-field=gap_m]").press("Enter")
    assert page.locator(".field", has=page.locator("[data-field=gap_m]")).locator("label").text_content() == "Gap (cm)"
    page.locator("[data-field=gap_m]").fill("0")
    page.locator("[data-field=gap_m]").press("Enter")
    page.locator("[data-field=gap_m][aria-invalid=true]").wait_for()
    with page.expect_download() as saving:
        choose_more(page, "save")
    saved = json.loads(saving.value.path().read_text())
    assert saved["shapes"][1] == {
        "kind": "slalom", "name": "slalom_1", "x_m": -0.4, "y_m": 0.3, "length_m": 1, "gap_m": 0.5,
    }  # fmt: skip
    page.click("#creator-try")
    page.locator(".palette").wait_for(state="detached")
    page.wait_for_function("() => window.thymio.state().markers > 4")
