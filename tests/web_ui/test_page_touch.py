"""Touch on a tablet: turn and zoom the view, press buttons on the robot and on the cross, drag the robot."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import pytest

from tests.web_ui.conftest import checked_page
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

RESTING = ("--playground", "base", "--program", "none")
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


@pytest.fixture
def tablet(browser) -> Iterator[Any]:
    """A checked page on a touch screen."""
    yield from checked_page(browser, has_touch=True)


def place_of(page: Any, part: str) -> tuple[float, float]:
    place = page.evaluate("(part) => window.thymio.partPosition(part)", part)
    return place["x"], place["y"]


def middle_of(page: Any, selector: str) -> tuple[float, float]:
    box = page.locator(selector).bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def corners(page: Any) -> list[tuple[float, float]]:
    """The screen positions of two corners of the playground."""
    return [(place["x"], place["y"]) for place in page.evaluate(CORNERS)]


def test_one_finger_turns_the_view_and_two_zoom_it(at_rest, tablet):
    open_page(tablet, at_rest)
    wait_for_position(tablet, "robot")
    touches = TouchPoints(tablet)
    before = corners(tablet)
    touches.start(a=(60, 300))
    touches.move(a=(180, 300))
    touches.end()
    tablet.wait_for_function(TURNED, arg=before[0])
    wait_for_position(tablet, "robot")
    turned = corners(tablet)
    touches.start(a=(60, 300), b=(100, 340))
    touches.move(a=(40, 280), b=(140, 380))
    touches.end()
    tablet.wait_for_function(ZOOMED, arg=1.2 * math.dist(*turned))


def test_two_fingers_press_two_buttons_on_the_robot_and_one_on_the_cross(at_rest, tablet):
    open_page(tablet, at_rest)
    tablet.locator("#view").focus()
    tablet.keyboard.press("f")
    wait_for_position(tablet, "button.center")
    touches = TouchPoints(tablet)
    touches.start(a=place_of(tablet, "button.forward"), b=place_of(tablet, "button.backward"))
    tablet.wait_for_function(
        "() => { const {forward, backward} = window.thymio.state().robot.buttons; return forward && backward; }"
    )
    touches.end()
    tablet.wait_for_function("() => !Object.values(window.thymio.state().robot.buttons).includes(true)")
    touches.start(a=middle_of(tablet, "[data-button=left]"), b=middle_of(tablet, "[data-button=center]"))
    tablet.wait_for_function(
        "() => { const {left, center} = window.thymio.state().robot.buttons; return left && center; }"
    )
    touches.end()
    tablet.wait_for_function("() => !Object.values(window.thymio.state().robot.buttons).includes(true)")


def test_a_robot_is_dragged_by_touch(suite, tablet):
    open_page(tablet, suite(*RESTING))
    wait_for_position(tablet, "robot")
    tablet.wait_for_function("() => window.thymio.state().services.includes('/simulator/set_poses')")
    before = tablet.evaluate(POSE)
    tablet.get_by_role("button", name="Move it").tap()
    tablet.wait_for_function("() => window.thymio.dragged() !== null")  # a tap becomes a click only later
    touches = TouchPoints(tablet)
    x, y = place_of(tablet, "robot")
    touches.start(a=(x, y))
    touches.move(a=(x + 60, y + 10))
    tablet.wait_for_function("() => window.thymio.dragged()?.blocker === null")
    touches.end()
    tablet.wait_for_function(
        "(before) => { const {x, y} = window.thymio.state().robot.latest.pose;"
        " return Math.hypot(x - before.x, y - before.y) > 0.05; }",
        arg=before,
    )


def test_on_a_phone_nothing_overflows_and_stop_is_visible(at_rest, tablet):
    tablet.set_viewport_size({"width": 412, "height": 860})
    open_page(tablet, at_rest)
    for go in (None, open_editor, build_playground):
        if go is not None:
            go(tablet)
        tablet.wait_for_function("() => document.documentElement.scrollWidth <= innerWidth")
        tablet.wait_for_function(STOP_IN_SIGHT)


FREE = """() => {
    const area = (selector) => {
        const {width, height} = document.querySelector(selector).getBoundingClientRect();
        return width * height;
    };
    return area(".scene") / (innerWidth * innerHeight);
}"""


@pytest.mark.parametrize("size", [(390, 844), (360, 640)])
def test_on_a_phone_the_view_keeps_more_than_half_of_the_page_and_the_pad_can_be_hidden(at_rest, tablet, size):
    tablet.set_viewport_size({"width": size[0], "height": size[1]})
    open_page(tablet, at_rest, unfold=False)
    for language in ("de", "fr", "it", "en"):
        choose_language(tablet, language)
        assert tablet.evaluate(FREE) > 0.5
    forward = tablet.locator("[data-button=forward]")
    show = tablet.locator("#tray-unfold")
    if show.is_visible():
        show.tap()
    open_menu(tablet, "#hands-more")
    tablet.locator("#tray-fold").tap()
    forward.wait_for(state="hidden")
    tablet.reload()
    tablet.wait_for_function("window.thymio && window.thymio.connected")
    show.wait_for()
    assert forward.is_hidden()
    show.tap()
    forward.wait_for(state="visible")
    tablet.set_viewport_size({"width": 1280, "height": 800})
    show.wait_for(state="hidden")
    forward.wait_for(state="visible")
