"""The settings in the menu, with their lights (docs/spec/thymio-behaviors.md section 2)."""

from __future__ import annotations

import pytest

from tests.device.behaviour_oracle import Pulse
from tests.device.handheld import HandheldRobot
from thymio_sim_ros.device.behavior_host import MENU

VOLUME, MOTORS, PAIRING = (32, 15, 0), (15, 32, 0), (15, 0, 32)
ALL = (32,) * 8
NONE = (0,) * 8


def in_settings():
    """A robot whose menu shows the settings, the first of them."""
    robot = HandheldRobot.switched_on(MENU)
    robot.touch("left", "right", ticks=103)
    return robot


def inside(setting):
    """A robot that is inside a setting: 0 volume, 1 motors, 2 pairing."""
    robot = in_settings()
    for _ in range(setting):
        robot.touch("forward")
    robot.touch("center")
    return robot


def word(robot, address):
    return robot.device.services.settings[address]


def test_left_and_right_together_for_two_seconds_open_the_settings():
    robot = HandheldRobot.switched_on(MENU)
    robot.touch("left", "right", ticks=99)
    assert robot.top == (0, 32, 0)
    robot.touch("left", "right", ticks=103)
    assert robot.top == robot.leds["bottom_left"] == robot.leds["bottom_right"] == VOLUME


@pytest.mark.parametrize(
    ("arrow", "expected"),
    [
        ("forward", [MOTORS, PAIRING, VOLUME]),
        ("left", [MOTORS, PAIRING, VOLUME]),
        ("backward", [PAIRING, MOTORS, VOLUME]),
        ("right", [PAIRING, MOTORS, VOLUME]),
    ],
)
def test_arrows_choose_a_setting(arrow, expected):
    robot, seen = in_settings(), []
    for _ in expected:
        robot.touch(arrow)
        seen.append(robot.top)
    assert seen == expected


def test_all_proximity_lights_blink_while_choosing():
    robot, lengths, last = in_settings(), [0], None
    for _ in range(28 * 6):
        robot.tick()
        lights = robot.leds["proximity"]
        assert lights in (ALL, NONE)
        if lights != last:
            lengths.append(0)
            last = lights
        lengths[-1] += 1
    assert lengths[2:-1] == [28] * (len(lengths) - 3)


def test_lights_and_colour_pulse_together_inside_a_setting():
    robot, pulse = inside(0), Pulse()
    levels = [min(pulse.next(), 32) for _ in range(3 * 200)][2::3]
    for level in levels[4:]:  # it began in the first tick after the touch, which lasted five
        robot.tick()
        assert robot.leds["proximity"] == (level,) * 8
        assert robot.top == tuple(part * level // 32 for part in VOLUME)


def test_volume_is_a_ramp_on_the_circle_and_stays_when_it_is_left():
    robot = inside(0)
    assert robot.leds["circle"] == (32, 28, 24, 20, 16, 12, 8, 4)
    robot.touch("backward")
    robot.touch("backward")
    assert robot.leds["circle"] == (24, 20, 16, 12, 8, 4, 0, 0)
    assert word(robot, 0) == 2
    for _ in range(9):
        robot.touch("backward")
    assert word(robot, 0) == 8
    assert robot.leds["circle"] == NONE
    robot.touch("forward")
    robot.touch("center")
    assert robot.leds["circle"] == NONE
    assert robot.top == VOLUME
    robot.touch("center")
    assert robot.leds["circle"] == (4, 0, 0, 0, 0, 0, 0, 0)


def test_what_is_set_survives_a_switch_off_and_on():
    robot = inside(0)
    robot.touch("backward")
    robot.touch("center")
    robot.device.run_control.switch_off()
    robot.device.run_control.resume()
    assert word(robot, 0) == 1


def test_the_motors_turn_by_steps_while_their_correction_is_set():
    robot = inside(1)
    robot.touch("forward")
    assert robot.targets == (128, 128)
    for _ in range(4):
        robot.touch("forward")
    assert robot.targets == (384, 384)
    robot.touch("center")
    assert robot.targets == (0, 0)
    assert robot.leds["proximity"] not in (ALL, NONE)
    robot.touch("backward")
    assert robot.targets == (-128, -128)


def test_the_correction_changes_only_while_the_wheels_turn():
    robot = inside(1)
    robot.touch("right")
    assert (word(robot, 8), word(robot, 9)) == (256, 256)
    robot.touch("forward")
    robot.touch("right")
    robot.touch("right")
    assert (word(robot, 8), word(robot, 9)) == (258, 254)
    assert robot.leds["circle"] == (0, 2, 0, 0, 0, 0, 0, 0)
    for _ in range(4):
        robot.touch("left")
    assert (word(robot, 8), word(robot, 9)) == (254, 258)
    assert robot.leds["circle"] == (0, 0, 0, 0, 0, 0, 0, 2)


@pytest.mark.parametrize(
    ("arrow", "factors", "circle"),
    [("right", (306, 206), (0, 31, 19, 0, 0, 0, 0, 0)), ("left", (206, 306), (0, 0, 0, 0, 0, 0, 19, 31))],
)
def test_the_correction_ends_at_50_and_flows_over_on_the_circle(arrow, factors, circle):
    robot = inside(1)
    robot.touch("forward")
    for _ in range(60):
        robot.touch(arrow)
    assert (word(robot, 8), word(robot, 9)) == factors
    assert robot.leds["circle"] == circle
    assert robot.targets == tuple(128 * factor >> 8 for factor in factors)


def test_pairing_lasts_until_the_centre_is_touched():
    robot = inside(2)
    robot.touch("forward")
    robot.tick(50)
    assert robot.leds["proximity"] not in (ALL, NONE)
    robot.touch("center")
    assert robot.top == PAIRING
