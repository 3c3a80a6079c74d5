"""Wheels: what they are to do, how their motors follow, and where they count from."""

from __future__ import annotations

import math
from dataclasses import dataclass

__all__ = [
    "MOTOR_MODELS",
    "BodyTwist",
    "Driving",
    "MotorTargets",
    "ResetOdometry",
    "SetMotorModel",
    "SetOdometry",
    "WheelVelocities",
]

MOTOR_MODELS = ("ideal", "firmware")
"""Without delay, or as the robot's own control loop moves them (docs/spec/thymio-robot.md sections 2 and 2.1)."""


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
class SetMotorModel:
    """Set how the motors follow their targets: one of `MOTOR_MODELS`. Raises ValueError for another name."""

    model: str

    def __post_init__(self) -> None:
        if self.model not in MOTOR_MODELS:
            raise ValueError(f"motor model {self.model!r} found, expected one of {', '.join(MOTOR_MODELS)}")


@dataclass(frozen=True, slots=True)
class ResetOdometry:
    """Reset the wheel odometry to zero at the present position."""


@dataclass(frozen=True, slots=True)
class SetOdometry:
    """Let the wheel odometry go on from a pose, in m and rad. Raises ValueError for values that are not finite."""

    x_m: float
    y_m: float
    yaw_rad: float

    def __post_init__(self) -> None:
        if not all(map(math.isfinite, (self.x_m, self.y_m, self.yaw_rad))):
            raise ValueError(f"odometry {self.x_m}, {self.y_m} m, {self.yaw_rad} rad found, expected finite numbers")


Driving = MotorTargets | WheelVelocities | BodyTwist | SetMotorModel | ResetOdometry | SetOdometry
