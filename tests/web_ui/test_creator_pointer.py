"""The playground creator by mouse and fingers: placing, dragging, turning, the camera, the grid."""

from __future__ import annotations

import math

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.web_ui.creator_support import (
    built,
    click,
    items,
    open_creator,
    spot,
    wait_for_camera,
    wait_for_items,
)
from tests.web_ui.page_support import (
    MARKS,
    TouchPoints,
    open_menu,
)

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
OVER = """(bar, {x, y}) => {
    const {left, right, bottom} = bar.getBoundingClientRect();
    return left < x && x < right && bottom < y && y - bottom < 120;
}"""
IN_SIGHT = """(one) => {
    const {left, top, right, bottom} = one.getBoundingClientRect();
    return one.contains(document.elementFromPoint((left + right) / 2, (top + bottom) / 2));
}"""


@pytest.mark.slow
def test_the_ghost_is_red_at_invalid_positions_and_the_reason_is_shown(at_rest, page):
    open_creator(page, at_rest)
    page.click("[data-tool=cylinder]")
    page.mouse.move(*spot(page, 0.0, 0.0))
    page.wait_for_function("window.thymio.built().problem === 'problem.blocked'")
    playwright.expect(page.locator(".placing-hint")).to_have_text("thymio is in the way")
    click(page, 0.0, 0.0)
    page.mouse.move(*spot(page, 0.3, 0.2))
    page.wait_for_function("window.thymio.built().problem === null")
    assert len(items(page)) == 2


@pytest.mark.slow
def test_positions_snap_to_the_grid_unless_alt_is_held_and_the_wheel_turns_the_ghost(at_rest, page):
    open_creator(page, at_rest)
    page.click("[data-tool=box]")
    click(page, 0.313, 0.207)
    wait_for_items(page, 3)
    page.mouse.move(*spot(page, -0.3, 0.2))
    page.wait_for_function("Math.abs(window.thymio.built().placing.place[0] + 0.3) < 0.01")
    page.mouse.wheel(0, 120 * page.evaluate("devicePixelRatio"))  # one notch
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


@pytest.mark.slow
def test_what_things_snap_to_is_chosen_in_the_bar_below(at_rest, page):
    open_creator(page, at_rest)
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


@pytest.mark.slow
def test_shift_toggles_the_camera_and_clicks_place_items_either_way(at_rest, page):
    open_creator(page, at_rest)
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


@pytest.mark.slow
def test_the_bar_over_the_selected_item_turns_copies_and_removes_it(at_rest, page):
    open_creator(page, at_rest)
    bar = page.locator(".context-bar")
    page.click("[data-tool=box]")
    click(page, 0.3, 0.2)
    wait_for_items(page, 3)
    playwright.expect(bar).to_be_hidden()
    page.keyboard.press("Escape")
    click(page, 0.3, 0.2, 0.05)
    playwright.expect(bar).to_be_visible()
    page.wait_for_function(
        f"(bar) => ({OVER})(bar, window.thymio.screenPosition(0.3, 0.2, 0.1))", arg=bar.element_handle()
    )
    bar.get_by_role("button", name="Turn").click()
    page.wait_for_function("Math.abs(window.thymio.built().playground.items[1].yaw_rad - Math.PI / 12) < 0.001")
    bar.get_by_role("button", name="Copy").click()
    wait_for_items(page, 4)
    assert built(page)["selected"] == "box_2"
    bar.get_by_role("button", name="Remove").click()
    wait_for_items(page, 3)
    playwright.expect(bar).to_be_hidden()
    assert page.evaluate("document.activeElement.id") == "view"


@pytest.mark.slow
def test_ten_thousand_moves_leave_one_animation_loop(at_rest, own_page):
    page = own_page
    page.add_init_script(f"({ONE_LOOP})()")
    open_creator(page, at_rest)
    page.click("[data-tool=u_figure]")
    page.evaluate(MOVES, 10_000)
    frames = page.evaluate("window.thymio.frames()")
    page.evaluate("window.drawn.most = 0")
    page.wait_for_function("(frames) => window.thymio.frames() > frames + 3", arg=frames, polling=100)
    assert page.evaluate("window.drawn.most") == 1
    assert frames < 2_000, "moves do not draw, frames do"


def test_items_are_placed_and_dragged_by_touch(at_rest, touch_page):
    page = touch_page
    open_creator(page, at_rest)
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


@pytest.mark.slow
@pytest.mark.parametrize("size", [(390, 844), (1024, 768)])
def test_all_tools_are_reached_by_touch(at_rest, touch_page, size):
    page = touch_page
    page.set_viewport_size({"width": size[0], "height": size[1]})
    open_creator(page, at_rest)
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


HINT_IS_BELOW = """() => {
    const buttons = [...document.querySelectorAll(".views .float .btn")].map((one) => one.getBoundingClientRect());
    const {top, height} = document.querySelector(".placing-hint").getBoundingClientRect();
    return height > 0 && buttons.every((one) => one.height === 0 || one.bottom <= top);
}"""


@pytest.mark.slow
@pytest.mark.parametrize("size", [(1024, 768), (640, 400), (390, 844)])
def test_the_hint_is_below_all_buttons_over_the_view(at_rest, page, size):
    page.set_viewport_size({"width": size[0], "height": size[1]})
    open_creator(page, at_rest)
    page.locator(".palette button").first.click()
    page.wait_for_function(HINT_IS_BELOW)
