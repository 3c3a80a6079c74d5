"""Describes values of messages beyond the limits of the robot, which are clamped and logged once per topic.

Each function returns a sentence for messages of one type, or an empty text (docs/spec/ros-interface.md section 4.2).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from typing import Any

from geometry_msgs.msg import Twist, TwistStamped
from std_msgs.msg import ColorRGBA, Float32, Float32MultiArray, Float64MultiArray, Int8, Int16, Int16MultiArray

from thymio_sim_ros.sim import commands
from thymio_sim_ros.sim.actuators.comm import FULL_PAYLOAD
from thymio_sim_ros.sim.actuators.motors import wanted_speeds
from thymio_sim_ros.sim.audio.synthesis import HIGHEST_HZ, LOWEST_HZ, SYSTEM_SOUNDS
from thymio_sim_ros.sim.model import robot_constants

__all__ = [
    "MAX_TONE_S",
    "LimitCheck",
    "brightness",
    "color",
    "frequency",
    "intensities",
    "light",
    "loudness",
    "nothing",
    "paint",
    "payload",
    "single",
    "sound_number",
    "stamped_twist",
    "system_sound",
    "targets",
    "threshold",
    "tone",
    "twist",
    "wheels",
]

LimitCheck = Callable[[Any], str]
"""Returns a sentence about the part of a message that will be clamped, or an empty text."""

MAX_TONE_S = 3600.0
"""Longest duration of a tone in s; a longer one is played until it is stopped."""
STOP_SOUND = -1
"""The number that stops the current sound."""

_ROUNDING = 1e-6
"""Relative tolerance of limits, for rounding errors of single-precision messages."""


def nothing(_message: object) -> str:
    """Return an empty text: for topics whose values have no limits, or are rejected beyond them."""
    return ""


def twist(message: Twist) -> str:
    """Describe speeds of the body that the wheels cannot reach."""
    return _speeds(commands.BodyTwist(message.linear.x, message.angular.z))


def stamped_twist(message: TwistStamped) -> str:
    """Describe speeds of the body, in a message with a stamp, that the wheels cannot reach."""
    return twist(message.twist)


def wheels(message: Float64MultiArray) -> str:
    """Describe wheel speeds that the wheels cannot reach."""
    left, right = message.data
    return _speeds(commands.WheelVelocities(left, right))


def _speeds(command: commands.BodyTwist | commands.WheelVelocities) -> str:
    fastest = max(abs(speed) for speed in wanted_speeds(command))
    if fastest <= robot_constants.MAX_SPEED_M_S * (1.0 + _ROUNDING):
        return ""
    return (
        f"a wheel would need {fastest:.3g} m/s, expected at most {robot_constants.MAX_SPEED_M_S:.3g};"
        " both wheels are slowed down together"
    )


def _outside(values: Iterable[float], low: float, high: float, what: str) -> str:
    for value in values:
        if not low - abs(low) * _ROUNDING <= value <= high + abs(high) * _ROUNDING:
            return f"found {what} {value:g}, expected {low:g} to {high:g}"
    return ""


def targets(message: Int16MultiArray) -> str:
    """Describe motor targets beyond full speed."""
    return _outside(message.data, -robot_constants.FULL_TARGET, robot_constants.FULL_TARGET, "target")


def color(message: ColorRGBA) -> str:
    """Describe parts of a color beyond 0…1: values up to 255 are a common mistake."""
    return _outside((message.r, message.g, message.b), 0.0, 1.0, "color")


def paint(message: ColorRGBA) -> str:
    """Describe parts of a color beyond 0…1, including alpha."""
    return color(message) or _outside((message.a,), 0.0, 1.0, "alpha")


def brightness(values: Iterable[float]) -> str:
    """Describe intensities of lights beyond 0…1."""
    return _outside(values, 0.0, 1.0, "intensity")


def intensities(message: Float32MultiArray) -> str:
    """Describe intensities of lights in a message beyond 0…1."""
    return brightness(message.data)


def _one(message: Float32, *, what: str) -> str:
    return _outside((message.data,), 0.0, 1.0, what)


loudness: LimitCheck = partial(_one, what="loudness")
light: LimitCheck = partial(_one, what="light")


def threshold(message: Float32) -> str:
    """Describe a threshold beyond 0…1: every sound is above a negative one, none above one beyond 1."""
    limit_check = _outside((message.data,), 0.0, 1.0, "threshold")
    every = "every" if message.data < 0.0 else "no"
    return limit_check and f"{limit_check} (0 is off); {every} sound is published with this value"


def tone(message: Float32MultiArray) -> str:
    """Describe a frequency that the loudspeaker cannot play, or a duration beyond `MAX_TONE_S`."""
    hertz, seconds = message.data
    if seconds < 0:
        return ""
    return frequency(hertz) or _outside((seconds,), 0.0, MAX_TONE_S, "seconds")


def frequency(hertz: float) -> str:
    """Describe a frequency in Hz that the loudspeaker cannot play; its sign is ignored."""
    return _outside((abs(hertz),), LOWEST_HZ, HIGHEST_HZ, "frequency")


def system_sound(message: Int8) -> str:
    """Describe the number, in a message, of a sound that the robot does not have."""
    return sound_number(message.data)


def sound_number(number: int) -> str:
    """Describe the number of a sound that the robot does not have."""
    limit_check = _outside((number,), STOP_SOUND, len(SYSTEM_SOUNDS) - 1, "sound")
    return limit_check and f"{limit_check}; the robot beeps instead"


def payload(message: Int16) -> str:
    """Describe a value that infrared frames cannot carry."""
    limit_check = _outside((message.data,), 0, FULL_PAYLOAD, "value")
    return f"{limit_check}; a negative one is a pulse without data" if message.data < 0 else limit_check


def single(message: Int16MultiArray) -> str:
    """Describe a brightness of one light beyond 0…32."""
    return _outside(message.data[1:], 0, commands.LED_FULL, "brightness")
