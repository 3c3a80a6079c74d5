"""Conversions from messages to commands, with common checks."""

from __future__ import annotations

import math
from typing import Any

from geometry_msgs.msg import Twist as TwistMsg

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.sim import commands


class CommandError(ThymioSimError, ValueError):
    """A rejected message; the text says what was found and what was expected."""


def body_twist(message: TwistMsg, timeout_ns: int) -> commands.BodyTwist:
    """Convert a geometry_msgs/Twist; only linear.x and angular.z are used. Raises CommandError for NaN and inf."""
    finite(message.linear.x, "linear.x")
    finite(message.angular.z, "angular.z")
    return commands.BodyTwist(message.linear.x, message.angular.z, timeout_ns)


def wheel_velocities(data: Any, timeout_ns: int) -> commands.WheelVelocities:
    """Convert [left, right] in rad/s. Raises CommandError for another number of values, NaN and inf."""
    values = sized(data, 2, "[left, right] in rad/s")
    for value in values:
        finite(value, "wheel speed")
    return commands.WheelVelocities(float(values[0]), float(values[1]), timeout_ns)


def motor_targets(data: Any) -> commands.MotorTargets:
    """Convert [left, right] in Thymio units. Raises CommandError for another number of values."""
    left, right = sized(data, 2, "[left, right] in Thymio units")
    return commands.MotorTargets(int(left), int(right))


def led_levels(group: str, intensities: Any) -> commands.SetLeds:
    """Convert intensities 0…1, clamped, to levels 0…32.

    Raises CommandError unless there is one finite intensity for each light of the group.
    """
    size = commands.LED_GROUPS[group]
    values = sized(intensities, size, f"{size} intensities 0…1")
    for value in values:
        finite(value, "intensity")
    return commands.SetLeds(group, tuple(round(min(max(v, 0.0), 1.0) * commands.LED_FULL) for v in values))


def sized(data: Any, size: int, what: str) -> list[Any]:
    """Return the values of an array. Raises CommandError unless it has `size` values."""
    values = list(data)
    if len(values) != size:
        raise CommandError(f"found {len(values)} values, expected {what}")
    return values


def finite(value: float, what: str) -> None:
    """Raise CommandError for NaN and infinities."""
    if not math.isfinite(value):
        raise CommandError(f"{what} is {value}, expected a finite number")
