"""Moving robots and objects: by pointer, by ring, by keys; occupied positions are rejected."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.bridge.studio import set_and_answer
from tests.web_ui.page_support import MARKS, open_page, wait_for_position, wait_for_program, wait_for_service
from thymio_sim_ros.bridge.protocol import messages as ms

pytestmark = MARKS

CAN = {"kind": "cylinder", "name": "can", "x_m": 0.4, "y_m": 0, "radius_m": 0.03, "height_m": 0.1, "mass_kg": 0.05}
GROUND = {"kind": "rectangle", "size_x_m": 1.6, "size_y_m": 1, "color": "#ffffff"}
BOX = {"kind": "box", "name": "box", "x_m": -0.4, "y_m": 0.2, "size_x_m": 0.2, "size_y_m": 0.2, "height_m": 0.1}
POSE = "() => window.thymio.state().robot.latest.pose"


@pytest.fixture
def still_world(tmp_path) -> Path:
    """A playground with a robot at rest, a movable can, and a fixed box."""
    shapes = [GROUND, CAN | {"color": "#cc3333"}, BOX | {"color": "#3333cc"}]
    robots = [{"name": "thymio", "x_m": 0, "y_m": 0}]
    path = tmp_path / "still.json"
    path.write_text(json.dumps({"format": 1, "title": "Still", "shapes": shapes, "robots": robots}))
    return path


def open_still(page, world, playground):
    open_page(page, world(playground))
    wait_for_service(page, "/simulator/set_poses")
    page.wait_for_function("() => window.thymio.state().objects.some(({name}) => name === 'can')")
    wait_for_position(page, "robot")


def drag(page, begin, end):
    """Drag from one point of the world (x, y, z) to another."""
    places = [page.evaluate("([x, y, z]) => window.thymio.screenPosition(x, y, z)", place) for place in (begin, end)]
    page.mouse.move(places[0]["x"], places[0]["y"])
    page.mouse.down()
    page.mouse.move(places[1]["x"], places[1]["y"], steps=4)


def test_a_robot_and_a_can_are_dragged_and_an_occupied_position_is_rejected(world, page, still_world):
    open_still(page, world, still_world)
    page.keyboard.down("Shift")
    drag(page, (0.02, 0, 0.05), (0.02, -0.25, 0.05))
    assert page.evaluate("() => window.thymio.dragged().blocker") is None
    page.mouse.up()
    page.wait_for_function(f"({POSE})().y < -0.2")
    drag(page, (0.4, 0, 0.1), (0.2, 0.2, 0.1))
    page.mouse.up()
    page.wait_for_function("() => window.thymio.state().objects[0].pose.position.y > 0.15")
    drag(page, (0.02, -0.25, 0.05), (-0.38, 0.2, 0.05))
    page.wait_for_function("() => window.thymio.dragged().blocker === 'box'")
    page.mouse.up()
    playwright.expect(page.locator(".notice.error")).to_contain_text("box")
    assert page.evaluate(POSE)["y"] == pytest.approx(-0.25, abs=0.02)


@pytest.mark.slow
def test_the_move_mode_turns_by_the_ring_and_moves_by_keys(world, page, still_world):
    open_still(page, world, still_world)
    page.locator("#view").focus()
    page.keyboard.press("m")
    page.wait_for_function("() => window.thymio.dragged() !== null")
    drag(page, (0.105, 0, 0), (0, 0.105, 0))
    page.mouse.up()
    page.wait_for_function(f"Math.abs(({POSE})().yaw - Math.PI / 2) < 0.1")
    page.wait_for_function("() => Math.abs(window.thymio.dragged().pose.yaw - Math.PI / 2) < 0.1")
    for key in ("Shift+ArrowRight", "Shift+ArrowRight", "Enter"):
        page.keyboard.press(key)
    page.wait_for_function(f"Math.abs(({POSE})().x - 0.1) < 0.01")
    page.keyboard.press("Escape")
    page.wait_for_function("() => window.thymio.dragged() === null")
    assert page.evaluate("() => window.thymio.state().robot.buttons.center") is False


@pytest.mark.slow
def test_a_fallen_robot_is_reported_and_put_back(world, page, tmp_path):
    ground = {"kind": "rectangle", "size_x_m": 0.8, "size_y_m": 0.8, "color": "#ffffff"}
    playground, program = tmp_path / "table.json", tmp_path / "off.aesl"
    robots = [{"name": "thymio", "x_m": 0.25, "y_m": 0}]
    playground.write_text(json.dumps({"format": 1, "title": "Table", "shapes": [ground], "robots": robots}))
    program.write_text("onevent button.forward\nmotor.left.target = 300\nmotor.right.target = 300\n")
    open_page(page, world(playground, program))
    wait_for_program(page, "off.aesl")
    with world.client() as client:
        set_and_answer(client, ms.Parameter("/web_ui.notice", "Look at the board"))
    note = page.locator(".teacher-note", has_text="Look at the board")
    note.wait_for()
    back = page.get_by_role("button", name="Put me back")
    playwright.expect(back).to_have_count(0)
    page.click("[data-button=forward]")
    playwright.expect(page.locator(".fallen")).to_contain_text("I fell.")
    playwright.expect(note).to_be_visible()
    page.click("button.stop")
    page.wait_for_function("() => Math.abs(window.thymio.state().robot.wheelSpeeds.left) < 0.1")
    back.click()
    page.wait_for_function(
        "() => { const {x, y, z} = window.thymio.state().robot.latest.pose;"
        " return Math.hypot(x - 0.25, y) < 0.02 && Math.abs(z) < 0.01; }"
    )
    playwright.expect(back).to_have_count(0)
