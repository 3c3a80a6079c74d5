"""Values of messages → commands: sizes and numbers checked, intensities clamped."""

from __future__ import annotations

import math

import pytest
from geometry_msgs.msg import Twist, Vector3

from thymio_sim_ros.ros.interface import command_checks
from thymio_sim_ros.ros.interface.command_checks import CommandError
from thymio_sim_ros.sim import commands


@pytest.mark.parametrize("level", range(33))
def test_a_level_survives_the_way_over_a_topic(level):
    assert command_checks.led_levels("remote", [level / commands.LED_FULL]).levels == (level,)


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_numbers_that_are_not_finite_are_refused(value):
    with pytest.raises(CommandError, match=r"linear\.x"):
        command_checks.body_twist(Twist(linear=Vector3(x=value)), 0)
    with pytest.raises(CommandError, match="finite"):
        command_checks.wheel_velocities([0.0, value], 0)
    with pytest.raises(CommandError, match="finite"):
        command_checks.led_levels("remote", [value])


def test_arrays_of_the_wrong_length_are_refused():
    with pytest.raises(CommandError, match="found 3 values, expected 8 intensities"):
        command_checks.led_levels("circle", [1.0, 1.0, 1.0])
    with pytest.raises(CommandError, match="left, right"):
        command_checks.motor_targets([1])


def test_intensities_are_clamped():
    assert command_checks.led_levels("ground", [-3.0, 7.0]).levels == (0, 32)
