"""What a test sees of a robot and does to it."""

from __future__ import annotations

import json
import math

import pytest

from thymio_sim_ros.sim.commands import SetPen
from thymio_sim_ros.testing import Classroom, Thymio

SENSES = """var heard = 0
var tapped = 0
var keyed = 0
var list[3] = [1, 2, 3]
mic.threshold = 50
onevent mic
heard = 1
onevent tap
tapped = 1
onevent rc5
keyed = rc5.command
"""
WALL = json.dumps(
    {
        "format": 1,
        "title": "Wall ahead",
        "shapes": [
            {"kind": "rectangle", "name": "floor", "size_x_m": 2.0, "size_y_m": 2.0, "color": "#ffffff"},
            {
                "kind": "box",
                "name": "wall",
                "x_m": 0.3,
                "y_m": 0,
                "size_x_m": 0.1,
                "size_y_m": 1,
                "height_m": 0.1,
                "color": "#ff0000",
            },
        ],
        "robots": [{"name": "thymio", "x_m": 0.0, "y_m": 0.0}],
    }
)


LISTENS = """
var claps
mic.threshold = 250
onevent mic
  claps++
"""


def alone(program: str = "none", playground: str = "base") -> Thymio:
    (thymio,) = Classroom(playground, program)
    return thymio


def test_variables_are_read_and_written_by_name() -> None:
    thymio = alone(SENSES)
    assert thymio["list"] == (1, 2, 3)
    assert thymio["heard"] == 0
    thymio["list"] = [4, 5, 6]
    thymio["heard"] = 2
    assert (thymio["list"], thymio["heard"]) == ((4, 5, 6), 2)
    assert thymio.variables["list"] == (4, 5, 6)


def test_an_unknown_variable_is_reported_with_similar_names() -> None:
    thymio = alone(SENSES)
    with pytest.raises(KeyError, match="no variable 'hear'; did you mean heard"):
        thymio["hear"]
    with pytest.raises(ValueError, match="list: 1 words found, expected 3"):
        thymio["list"] = 1


def test_claps_taps_and_keys_are_felt() -> None:
    thymio = alone(SENSES)
    thymio.run(0.2)
    thymio.clap()
    thymio.tap()
    thymio.key(80)
    thymio.until(lambda: thymio["heard"] and thymio["tapped"] and thymio["keyed"] == 80, 1.0)


def test_a_clap_is_louder_than_the_thresholds_of_vpl_and_of_the_attentive_behavior() -> None:
    thymio = alone(LISTENS)
    thymio.run(0.2)
    thymio.clap()
    thymio.until(lambda: thymio["claps"] > 0, 1.0)


def test_a_tilt_is_felt() -> None:
    thymio = alone()
    thymio.tilt(roll_rad=math.pi / 2)
    thymio.until(lambda: abs(thymio.variables["acc"][0]) > 20, 1.0)


def test_fingers_come_and_go() -> None:
    thymio = alone("var count = 0\nonevent button.left\ncount = count * 10 + 1 + button.left")
    thymio.touch("left")
    assert thymio["count"] == 21
    with pytest.raises(ValueError, match="no button 'up': expected one of backward"):
        thymio.press("up")


def test_a_pen_draws_where_the_robot_goes() -> None:
    thymio = alone("motor.left.target = 200\nmotor.right.target = 200")
    thymio.draw("#ff0000", 0.01)
    thymio.run(1.0)
    thymio.lift_pen()
    (stroke,) = thymio.drawing
    assert stroke.color == (1.0, 0.0, 0.0)
    assert stroke.points[-1][0] > 0.04


def test_a_pen_that_is_given_after_an_eraser_draws() -> None:
    thymio = alone("motor.left.target = 200\nmotor.right.target = 200")
    thymio.post(SetPen(down=True, erase=True))
    thymio.run(0.5)
    thymio.draw("#ff0000")
    thymio.run(0.5)
    assert thymio.drawing[-1].color == (1.0, 0.0, 0.0)


def test_the_path_has_a_moment_for_each_tick() -> None:
    thymio = alone("motor.left.target = 200\nmotor.right.target = 200")
    thymio.run(0.5)
    assert [round(moment.at_s * 100) for moment in thymio.path] == list(range(1, 51))
    assert thymio.path[-1].pose == thymio.pose
    assert thymio.path[-1].speed_m_s == thymio.speed > 0.04


def test_what_it_begins_to_touch_is_noted_once() -> None:
    thymio = alone("motor.left.target = 300\nmotor.right.target = 300", WALL)
    thymio.until(lambda: thymio.touching, 10.0)
    thymio.run(2.0)
    assert thymio.touching == ("wall",)
    assert [touch.other for touch in thymio.touches] == ["wall"]
    assert thymio.touches[0].at_s > 1.0


def test_it_can_be_put_somewhere() -> None:
    thymio = alone()
    thymio.place(0.2, -0.1, math.pi / 2)
    thymio.run(0.01)
    assert (thymio.pose.x_m, thymio.pose.y_m, thymio.pose.yaw_rad) == pytest.approx((0.2, -0.1, math.pi / 2))


def test_lights_are_given_by_group() -> None:
    thymio = alone("call leds.top(32, 0, 16)")
    thymio.run(0.1)
    assert thymio.level("top") == thymio.leds["top"] == (32, 0, 16)
    with pytest.raises(KeyError, match="no lights 'roof': expected one of top"):
        thymio.level("roof")


def test_its_machine_has_a_status() -> None:
    thymio = alone("var a = 0\na = 1 / a")
    assert (thymio.status.state, thymio.status.line) == ("fault", 2)
