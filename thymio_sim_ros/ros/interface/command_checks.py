"""Conversions from messages to commands, with common checks."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, TypeVar

from geometry_msgs.msg import Twist as TwistMsg

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.sim import commands

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message


N = TypeVar("N", int, float)


class CommandError(ThymioSimError, ValueError):
    """A rejected message; the text says what was found and what was expected."""


class NotFiniteError(CommandError):
    """A rejected message with NaN or an infinity."""


SMALLEST = 1e-300
"""Numbers nearer to zero, except zero, are no commands: rclpy sends the int n in a float field as n · 5e-324."""


def tiny_field(message: Message) -> str:
    """Return the name of a field with a float below `SMALLEST`; empty if there is none."""
    for name, kind in message.get_fields_and_field_types().items():
        value = getattr(message, name)
        if kind == "double":
            values = (value,)
        elif "double" in kind:
            values = value
        else:
            inner = tiny_field(value) if hasattr(value, "get_fields_and_field_types") else ""
            if inner:
                return f"{name}.{inner}"
            continue
        if any(0.0 < abs(number) < SMALLEST for number in values):
            return str(name)
    return ""


def body_twist(message: TwistMsg, timeout_ns: int) -> commands.BodyTwist:
    """Convert a geometry_msgs/Twist; only linear.x and angular.z are used. Raises CommandError for NaN and inf."""
    finite(message.linear.x, "linear.x")
    finite(message.angular.z, "angular.z")
    return commands.BodyTwist(message.linear.x, message.angular.z, timeout_ns)


def wheel_velocities(data: Iterable[float], timeout_ns: int) -> commands.WheelVelocities:
    """Convert [left, right] in rad/s. Raises CommandError for another number of values, NaN and inf."""
    values = sized(data, 2, "[left, right] in rad/s")
    for value in values:
        finite(value, "wheel speed")
    return commands.WheelVelocities(float(values[0]), float(values[1]), timeout_ns)


def motor_targets(data: Iterable[int]) -> commands.MotorTargets:
    """Convert [left, right] in Thymio units. Raises CommandError for another number of values."""
    left, right = sized(data, 2, "[left, right] in Thymio units")
    return commands.MotorTargets(int(left), int(right))


def led_levels(group: str, intensities: Iterable[float]) -> commands.SetLeds:
    """Convert intensities 0…1, clamped, to levels 0…32.

    Raises CommandError unless there is one finite intensity for each light of the group.
    """
    size = commands.LED_GROUPS[group]
    values = sized(intensities, size, f"{size} intensities 0…1")
    for value in values:
        finite(value, "intensity")
    return commands.SetLeds(group, tuple(round(min(max(v, 0.0), 1.0) * commands.LED_FULL) for v in values))


def sized(data: Iterable[N], size: int, what: str) -> list[N]:
    """Return the values of an array. Raises CommandError unless it has `size` values."""
    values = list(data)
    if len(values) != size:
        raise CommandError(f"found {len(values)} values, expected {what}")
    return values


def finite(value: float, what: str) -> None:
    """Raise NotFiniteError for NaN and infinities."""
    if not math.isfinite(value):
        raise NotFiniteError(f"{what} is {value}, expected a finite number")
