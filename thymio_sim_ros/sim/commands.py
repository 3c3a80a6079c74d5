"""Everything that goes into the world: one frozen value per thing a robot can be told.

Commands are posted at any time and take effect at the next tick, in the order of arrival
(`World.post`). They carry SI units, except where a field is a Thymio integer by name.
"""

from __future__ import annotations

from dataclasses import dataclass

BUTTONS = ("backward", "left", "center", "forward", "right")
"""The five buttons, in the order of the firmware's variables (thymio-robot.md section 4)."""

LED_GROUPS: dict[str, int] = {
    "top": 3,
    "bottom_left": 3,
    "bottom_right": 3,
    "circle": 8,
    "buttons": 4,
    "proximity": 8,
    "ground": 2,
    "temperature": 2,
    "microphone": 1,
    "remote": 1,
}
"""LED groups and their number of lights (thymio-robot.md sections 6.3 and 8)."""

LED_FULL = 32
"""Brightness of a fully lit LED (thymio-robot.md section 8.1)."""


@dataclass(frozen=True, slots=True)
class MotorTargets:
    """Wheel targets of an Aseba program, in Thymio units (int16; ±500 is full speed). They persist."""

    left: int
    right: int


@dataclass(frozen=True, slots=True)
class WheelVelocities:
    """Wheel speeds in rad/s, forward positive; they end after `timeout_ns` (0: never)."""

    left_rad_s: float
    right_rad_s: float
    timeout_ns: int = 0


@dataclass(frozen=True, slots=True)
class BodyTwist:
    """Speed of the body in m/s and rad/s (REP 103); it ends after `timeout_ns` (0: never)."""

    linear_m_s: float
    angular_rad_s: float
    timeout_ns: int = 0


@dataclass(frozen=True, slots=True)
class SetLeds:
    """Brightness 0…32 of every light of one group of `LED_GROUPS`."""

    group: str
    levels: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class PressButton:
    """A finger put on (or taken off) one of `BUTTONS`."""

    button: str
    pressed: bool


@dataclass(frozen=True, slots=True)
class MoveRobot:
    """Put the robot somewhere (metres, radians, world frame); its odometry does not notice."""

    x_m: float
    y_m: float
    yaw_rad: float


@dataclass(frozen=True, slots=True)
class ResetOdometry:
    """Let the wheel odometry start again from zero, here."""


Command = MotorTargets | WheelVelocities | BodyTwist | SetLeds | PressButton | MoveRobot | ResetOdometry
