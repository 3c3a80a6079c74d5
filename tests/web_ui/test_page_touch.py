"""Touch on a touch_page: turn and zoom the view, press buttons on the robot and on the cross, drag the robot."""

from __future__ import annotations

import math
from typing import Any

import pytest

from tests.web_ui.page_support import (
    MARKS,
    TouchPoints,
    build_playground,
    choose_language,
    open_editor,
    open_menu,
    open_page,
    wait_for_position,
)

pytestmark = MARKS

POSE = "() => window.thymio.state().robot.latest.pose"
CORNERS = "() => [[0.4, 0.4, 0], [-0.4, -0.4, 0]].map(([x, y, z]) => window.thymio.screenPosition(x, y, z))"

TURNED = f"""([x, y]) => {{
    const [place] = ({CORNERS})();
    return place !== null && Math.hypot(place.x - x, place.y - y) > 20;
}}"""
ZOOMED = f"""(least) => {{
    const [one, other] = ({CORNERS})();
    return one !== null && other !== null && Math.hypot(one.x - other.x, one.y - other.y) > least;
}}"""
STOP_IN_SIGHT = """() => {
    const {left, top, width, height} = document.querySelector("button.stop").getBoundingClientRect();
    return Boolean(document.elementFromPoint(left + width / 2, top + height / 2)?.closest("button.stop"));
}"""


def place_of(page: Any, part: str) -> tuple[float, float]:
    place = page.evaluate("(part) => window.thymio.partPosition(part)", part)
    return place["x"], place["y"]


def middle_of(page: Any, selector: str) -> tuple[float, float]:
    box = page.locator(selector).bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def corners(page: Any) -> list[tuple[float, float]]:
    """The screen positions of two corners of the playground."""
    return [(place["x"], place["y"]) for place in page.evaluate(CORNERS)]


@pytest.mark.slow
def test_one_finger_turns_the_view_and_two_zoom_it(at_rest, touch_page):
    open_page(touch_page, at_rest)
    wait_for_position(touch_page, "robot")
    touches = TouchPoints(touch_page)
    before = corners(touch_page)
    touches.start(a=(60, 300))
    touches.move(a=(180, 300))
    touches.end()
    touch_page.wait_for_function(TURNED, arg=before[0])
    wait_for_position(touch_page, "robot")
    turned = corners(touch_page)
    touches.start(a=(60, 300), b=(100, 340))
    touches.move(a=(40, 280), b=(140, 380))
    touches.end()
    touch_page.wait_for_function(ZOOMED, arg=1.2 * math.dist(*turned))


def test_two_fingers_press_two_buttons_on_the_robot_and_one_on_the_cross(at_rest, touch_page):
    open_page(touch_page, at_rest)
    touch_page.locator("#view").focus()
    touch_page.keyboard.press("f")
    wait_for_position(touch_page, "button.center")
    touches = TouchPoints(touch_page)
    touches.start(a=place_of(touch_page, "button.forward"), b=place_of(touch_page, "button.backward"))
    touch_page.wait_for_function(
        "() => { const {forward, backward} = window.thymio.state().robot.buttons; return forward && backward; }"
    )
    touches.end()
    touch_page.wait_for_function("() => !Object.values(window.thymio.state().robot.buttons).includes(true)")
    touches.start(a=middle_of(touch_page, "[data-button=left]"), b=middle_of(touch_page, "[data-button=center]"))
    touch_page.wait_for_function(
        "() => { const {left, center} = window.thymio.state().robot.buttons; return left && center; }"
    )
    touches.end()
    touch_page.wait_for_function("() => !Object.values(window.thymio.state().robot.buttons).includes(true)")


@pytest.mark.slow
def test_a_robot_is_dragged_by_touch(world, touch_page):
    open_page(touch_page, world("base"))
    wait_for_position(touch_page, "robot")
    touch_page.wait_for_function("() => window.thymio.state().services.includes('/simulator/set_poses')")
    before = touch_page.evaluate(POSE)
    touch_page.get_by_role("button", name="Move it").tap()
    touch_page.wait_for_function("() => window.thymio.dragged() !== null")  # a tap becomes a click only later
    touches = TouchPoints(touch_page)
    x, y = place_of(touch_page, "robot")
    touches.start(a=(x, y))
    touches.move(a=(x + 60, y + 10))
    touch_page.wait_for_function("() => window.thymio.dragged()?.blocker === null")
    touches.end()
    touch_page.wait_for_function(
        "(before) => { const {x, y} = window.thymio.state().robot.latest.pose;"
        " return Math.hypot(x - before.x, y - before.y) > 0.05; }",
        arg=before,
    )


@pytest.mark.slow
def test_on_a_phone_nothing_overflows_and_stop_is_visible(at_rest, touch_page):
    touch_page.set_viewport_size({"width": 412, "height": 860})
    open_page(touch_page, at_rest)
    for go in (None, open_editor, build_playground):
        if go is not None:
            go(touch_page)
        touch_page.wait_for_function("() => document.documentElement.scrollWidth <= innerWidth")
        touch_page.wait_for_function(STOP_IN_SIGHT)


FREE = """() => {
    const area = (selector) => {
        const {width, height} = document.querySelector(selector).getBoundingClientRect();
        return width * height;
    };
    return area(".scene") / (innerWidth * innerHeight);
}"""


@pytest.mark.slow
@pytest.mark.parametrize("size", [(390, 844), (360, 640)])
def test_on_a_phone_the_view_keeps_more_than_half_of_the_page_and_the_pad_can_be_hidden(at_rest, touch_page, size):
    touch_page.set_viewport_size({"width": size[0], "height": size[1]})
    open_page(touch_page, at_rest, unfold=False)
    for language in ("de", "fr", "it", "en"):
        choose_language(touch_page, language)
        touch_page.wait_for_function(f"() => ({FREE})() > 0.5")
    forward = touch_page.locator("[data-button=forward]")
    show = touch_page.locator("#tray-unfold")
    if show.is_visible():
        show.tap()
    open_menu(touch_page, "#hands-more")
    touch_page.locator("#tray-fold").tap()
    forward.wait_for(state="hidden")
    touch_page.reload()
    touch_page.wait_for_function("window.thymio && window.thymio.connected")
    show.wait_for()
    assert forward.is_hidden()
    show.tap()
    forward.wait_for(state="visible")
    touch_page.set_viewport_size({"width": 1280, "height": 800})
    show.wait_for(state="hidden")
    forward.wait_for(state="visible")
