"""The two wheels of a robot: what they are told, how far they turned, and the odometry counted from them."""

from __future__ import annotations

import math

from thymio_sim_ros.sim.geometry import Pose, Twist
from thymio_sim_ros.sim.motor_control import WheelControl
from thymio_sim_ros.sim.thymio2 import WHEEL_RADIUS_M, WHEEL_TRACK_M

__all__ = ["Wheels"]


class Wheels:
    """Speeds in m/s at the rim, left then right.

    `commanded` is what the motors aim at, `ground` what reaches the floor after slip. While nothing holds the robot,
    the wheels turn as commanded; what an obstacle takes from the ground speed, it takes from the wheels. `control` are
    the loops that the motors follow, if they do not follow at once.
    """

    __slots__ = ("angles_rad", "commanded", "control", "ground", "odometry", "speeds_m_s")

    def __init__(self) -> None:
        self.commanded = (0.0, 0.0)
        self.control: tuple[WheelControl, WheelControl] | None = None
        self.ground = (0.0, 0.0)
        self.speeds_m_s = (0.0, 0.0)
        self.angles_rad = (0.0, 0.0)
        self.odometry = Pose(0.0, 0.0, 0.0)

    @property
    def twist(self) -> Twist:
        """The body's motion as the wheels tell it."""
        left, right = self.speeds_m_s
        return Twist((left + right) / 2, (right - left) / WHEEL_TRACK_M)

    def drive(self, commanded: tuple[float, float], slip: tuple[float, float], limit_m_s: float) -> None:
        """Aim at speeds; the floor gets them times slip. Both are limited: far above, nothing of the slip is left."""
        left, right = commanded
        self.commanded = (_limited(left, limit_m_s), _limited(right, limit_m_s))
        self.ground = (_limited(left * slip[0], limit_m_s), _limited(right * slip[1], limit_m_s))

    def roll(self, covered_m_s: tuple[float, float], dt_s: float) -> None:
        """Count a tick in which the robot covered ground at this speed at each wheel."""
        if covered_m_s == self.ground:
            self.speeds_m_s = self.commanded
        else:
            self.speeds_m_s = (
                self.commanded[0] + (covered_m_s[0] - self.ground[0]),
                self.commanded[1] + (covered_m_s[1] - self.ground[1]),
            )
        left, right = self.speeds_m_s
        if left == 0.0 and right == 0.0:
            return
        way, turn = (left + right) / 2 * dt_s, (right - left) / WHEEL_TRACK_M * dt_s
        start = self.odometry
        heading = start.yaw_rad + turn / 2
        self.odometry = Pose(
            start.x_m + way * math.cos(heading), start.y_m + way * math.sin(heading), start.yaw_rad + turn
        )
        angle_left, angle_right = self.angles_rad
        per_m = dt_s / WHEEL_RADIUS_M
        self.angles_rad = (angle_left + left * per_m, angle_right + right * per_m)

    def reset_odometry(self) -> None:
        """Start counting from zero, here."""
        self.odometry = Pose(0.0, 0.0, 0.0)


def _limited(speed_m_s: float, limit_m_s: float) -> float:
    return max(-limit_m_s, min(limit_m_s, speed_m_s))
