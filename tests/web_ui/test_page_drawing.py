"""The view is never empty: at every level of quality, after every change of its size, and at rest."""

from __future__ import annotations

import io
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

playwright = pytest.importorskip("playwright.sync_api")

from PIL import Image

from tests.web_ui.page_support import MARKS, build_playground, open_page, open_tab
from tests.web_ui.tabs import checked_page

pytestmark = MARKS

CIRCLE = "motor.left.target = 100\nmotor.right.target = 200\n"
PLACE = (0.3, -0.3)
"""On the floor of "base", away from walls and from the robot's circle."""
FLOOR = np.array([190, 184, 175])
"""Its color as it is drawn; by day, and in the evening of the dark theme."""
EVENING = np.array([0.66, 0.625, 0.58])
LEVELS = (2, 3, 4, 5)

WATCH = """() => {
    window.slowMs = 0;
    window.emptyFrames = 0;
    let isEmpty = false;
    for (const side of ["width", "height"]) {
        const {get, set} = Object.getOwnPropertyDescriptor(HTMLCanvasElement.prototype, side);
        Object.defineProperty(HTMLCanvasElement.prototype, side, {get, set(value) {
            if (this.id === "view") isEmpty = true;
            set.call(this, value);
        }});
    }
    for (const name of ["drawElements", "drawElementsInstanced", "drawArrays", "drawArraysInstanced"]) {
        const draw = WebGL2RenderingContext.prototype[name];
        WebGL2RenderingContext.prototype[name] = function (...how) {
            if (this.canvas.id === "view") isEmpty = false;
            return draw.apply(this, how);
        };
    }
    window.keptFrames = 0;
    const copy = WebGL2RenderingContext.prototype.blitFramebuffer;
    WebGL2RenderingContext.prototype.blitFramebuffer = function (...how) {
        window.keptFrames += 1;
        return copy.apply(this, how);
    };
    const request = window.requestAnimationFrame.bind(window);
    window.requestAnimationFrame = (callback) => request((nowMs) => {
        const end = performance.now() + window.slowMs;
        while (performance.now() < end);
        callback(nowMs);
    });
    const shown = new MessageChannel();  // a message of a frame arrives when the browser has shown it
    shown.port1.onmessage = () => { if (isEmpty) window.emptyFrames += 1; };
    const watch = () => { shown.port2.postMessage(null); request(watch); };
    request(watch);
}"""
RESTS = """() => {
    const view = document.querySelector("#view");
    return view.width === view.clientWidth && view.height === view.clientHeight;
}"""
CONTEXT = "document.querySelector('#view').getContext('webgl2').getExtension('WEBGL_lose_context')"
FRAMES = """async () => {
    for (let frame = 0; frame < 4; frame++) await new Promise((end) => requestAnimationFrame(end));
}"""


@pytest.fixture
def page(browser) -> Iterator[Any]:
    """A page in full resolution, because its picture is compared."""
    yield from checked_page(browser, compares_pictures=True)


@pytest.fixture
def driving(world, page, tmp_path) -> Any:
    """A robot that drives in a circle."""
    program = tmp_path / "circle.aesl"
    program.write_text(CIRCLE)
    page.add_init_script(f"({WATCH})()")
    page.set_viewport_size({"width": 1280, "height": 800})
    open_page(page, world("base", program))
    page.add_style_tag(content=".scene::after { display: none; }")  # the shade while time is paused
    return page


def pause(page, paused):
    page.locator("#pause").click()
    page.wait_for_function("(paused) => window.thymio.state().simulator.paused === paused", arg=paused)


def check(page, what, light=1.0):
    """Floor and robot are in the picture of the page."""
    page.wait_for_function(RESTS)
    page.evaluate(FRAMES)
    image = np.asarray(Image.open(io.BytesIO(page.screenshot())).convert("RGB")).astype(int)
    floor = around(image, page.evaluate("([x, y]) => window.thymio.screenPosition(x, y, 0)", PLACE), 3)
    assert np.abs(floor.mean(axis=0) - FLOOR * light).max() < 12, f"the floor: {what}"
    robot = around(image, page.evaluate("() => window.thymio.partPosition('robot')"), 10)
    assert (robot.mean(axis=0) > floor.mean(axis=0) + 20).all(), f"the robot, which is brighter: {what}"


def around(image, place, reach):
    x, y = round(place["x"]), round(place["y"])
    return image[y - reach : y + reach + 1, x - reach : x + reach + 1].reshape(-1, 3)


@pytest.mark.slow
def test_while_the_camera_rests_the_ground_is_copied_and_not_drawn_again(driving):
    driving.wait_for_function("() => window.keptFrames > 10")
    pause(driving, True)
    check(driving, "copied")


@pytest.mark.slow
def test_floor_and_robot_are_seen_at_rest_at_every_level(driving):
    for level in LEVELS:
        driving.evaluate("() => { window.slowMs = 60; }")
        driving.wait_for_function("(level) => window.thymio.level() >= level", arg=level)
        driving.evaluate("() => { window.slowMs = 0; }")
        pause(driving, True)
        check(driving, f"level {level}, at rest")
        driving.set_viewport_size({"width": 1200, "height": 740})
        check(driving, f"level {level}, smaller")
        driving.set_viewport_size({"width": 1280, "height": 800})
        open_tab(driving, "robot")
        check(driving, f"level {level}, beside a tab")
        driving.locator("#work-fold").click()
        check(driving, f"level {level}, without it")
        pause(driving, False)
    assert driving.evaluate("window.thymio.level()") == LEVELS[-1]
    assert driving.evaluate("window.emptyFrames") == 0


@pytest.mark.slow
def test_floor_and_robot_are_seen_after_whatever_hides_or_changes_the_view(driving):
    page = driving
    pause(page, True)
    build_playground(page)
    open_tab(page, "program")
    check(page, "after the creator")
    for theme, light in (("dark", EVENING), ("light", 1.0)):
        page.emulate_media(color_scheme=theme)
        check(page, f"{theme} theme", light)
    page.set_viewport_size({"width": 390, "height": 844})
    page.locator("#view").wait_for(state="hidden")
    page.set_viewport_size({"width": 1280, "height": 800})
    check(page, "hidden before")
    page.evaluate(f"() => {{ window.graphics = {CONTEXT}; window.graphics.loseContext(); }}")
    page.locator("#trouble").wait_for()
    page.evaluate("() => window.graphics.restoreContext()")
    page.locator("#trouble").wait_for(state="hidden")
    check(page, "with the context back")
    with page.expect_download():
        page.locator("[data-view=picture]").click()
    check(page, "after a picture")
    assert page.evaluate("window.emptyFrames") == 0
