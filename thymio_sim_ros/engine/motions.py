"""Laws by which a robot reaches a goal: turn by an angle, drive a distance, an arc, or to a pose.

A law is called after each tick of 10 ms with the pose by odometry, and returns the velocity of the next tick. It
depends on nothing else, so that the same run gives the same motion, whatever is measured or published. Speeds fall in
proportion to what remains, from the largest speed down to a least one, so that the robot stops within the tolerance at
any motor model.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Protocol

from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.sim.model.geometry import Pose, wrap_angle
from thymio_sim_ros.sim.model.robot_constants import MAX_SPEED_M_S, WHEEL_TRACK_M

__all__ = [
    "MAX_TURN_RAD_S",
    "Arc",
    "Distance",
    "Law",
    "Remaining",
    "StallDetector",
    "ToPose",
    "Turn",
    "Velocity",
]

MAX_TURN_RAD_S = 2 * MAX_SPEED_M_S / WHEEL_TRACK_M
"""Largest turn rate: both wheels at their limit."""

_TICK_S = TICK_NS * 1e-9
_TURN_TIME_S, _DRIVE_TIME_S = 0.25, 0.3
"""What remains is covered in this time, exponentially, once the largest speed would overshoot."""
_LEAST_TURN_RAD_S, _LEAST_DRIVE_M_S = 0.04, 0.004
_TURN_TOLERANCE_RAD, _DRIVE_TOLERANCE_M = 0.003, 0.0005
_HEADING_GAIN = 4.0
"""Turn rate for each radian off the line, 1/s."""
_SIDE_GAIN = 8.0
"""Wanted heading for each meter beside the line, rad/m."""
_NEAR_M = 0.01
"""So near to a position its direction is not followed any more: it turns quickly."""
_ASIDE_RAD = 0.6
"""Beyond this angle off the direction of a position the robot only turns."""


@dataclass(frozen=True, slots=True)
class Velocity:
    """Velocity of the body, in m/s and rad/s."""

    linear_m_s: float = 0.0
    angular_rad_s: float = 0.0


@dataclass(frozen=True, slots=True)
class Remaining:
    """What remains of a goal: distance in m and angle in rad, with signs where the goal has one."""

    distance_m: float = 0.0
    angle_rad: float = 0.0


class Law(Protocol):
    """One motion of a robot."""

    remaining: Remaining
    """What remains, as of the last call."""

    def velocity(self, odometry: Pose) -> Velocity | None:
        """Return the velocity of the next tick, or None if the goal is reached."""


def _falling(remaining: float, largest: float, least: float, time_s: float) -> float:
    """The speed for what remains, with its sign, at most so that the next tick does not overshoot."""
    size = abs(remaining)
    speed = min(largest, max(size / time_s, least), size / _TICK_S)
    return math.copysign(speed, remaining)


@dataclass(slots=True)
class _Heading:
    """The angle that a robot has turned since the start, not wrapped."""

    yaw_rad: float
    turned_rad: float = 0.0

    def update(self, yaw_rad: float) -> float:
        self.turned_rad += wrap_angle(yaw_rad - self.yaw_rad)
        self.yaw_rad = yaw_rad
        return self.turned_rad


class Turn:
    """Turn on the spot by an angle, counter-clockwise if positive; more than a full turn is possible."""

    def __init__(self, start: Pose, angle_rad: float, largest_rad_s: float = MAX_TURN_RAD_S) -> None:
        """`start`: the pose by odometry; `largest_rad_s`: turn rate, above 0, which is limited to that of the robot."""
        self._angle_rad, self._largest_rad_s = angle_rad, min(largest_rad_s, MAX_TURN_RAD_S)
        self._heading = _Heading(start.yaw_rad)
        self.remaining = Remaining(angle_rad=angle_rad)

    def velocity(self, odometry: Pose) -> Velocity | None:
        """See `Law`."""
        left_rad = self._angle_rad - self._heading.update(odometry.yaw_rad)
        self.remaining = Remaining(angle_rad=left_rad)
        if abs(left_rad) <= _TURN_TOLERANCE_RAD:
            return None
        return Velocity(0.0, _falling(left_rad, self._largest_rad_s, _LEAST_TURN_RAD_S, _TURN_TIME_S))


class Distance:
    """Drive a distance straight ahead, backward if it is negative, on the line of the start."""

    def __init__(self, start: Pose, distance_m: float, largest_m_s: float = MAX_SPEED_M_S) -> None:
        """`start`: the pose by odometry; `largest_m_s`: speed, above 0, which is limited to that of the robot."""
        self._start, self._distance_m = start, distance_m
        self._largest_m_s = min(largest_m_s, MAX_SPEED_M_S)
        self.remaining = Remaining(distance_m)

    def velocity(self, odometry: Pose) -> Velocity | None:
        """See `Law`."""
        start, cos, sin = self._start, math.cos(self._start.yaw_rad), math.sin(self._start.yaw_rad)
        dx, dy = odometry.x_m - start.x_m, odometry.y_m - start.y_m
        left_m = self._distance_m - (cos * dx + sin * dy)
        self.remaining = Remaining(left_m)
        if abs(left_m) <= _DRIVE_TOLERANCE_M:
            return None
        speed = _falling(left_m, self._largest_m_s, _LEAST_DRIVE_M_S, _DRIVE_TIME_S)
        aside_m = cos * dy - sin * dx
        wanted = start.yaw_rad - math.copysign(min(_SIDE_GAIN * abs(aside_m), 0.3), aside_m * speed)
        return Velocity(speed, _HEADING_GAIN * wrap_angle(wanted - odometry.yaw_rad))


class Arc:
    """Drive an arc until the heading has turned by an angle."""

    def __init__(
        self, start: Pose, angle_rad: float, radius_m: float, *, backward: bool = False, largest_m_s: float
    ) -> None:
        """`angle_rad`: counter-clockwise if positive. `radius_m`: of the path of the robot's middle, at least 0."""
        largest_m_s = min(largest_m_s, MAX_SPEED_M_S)
        # The outer wheel is limited, too.
        self._largest_rad_s = min(
            largest_m_s / radius_m if radius_m else math.inf, MAX_SPEED_M_S / (radius_m + WHEEL_TRACK_M / 2)
        )
        self._angle_rad, self._radius_m = angle_rad, -radius_m if backward else radius_m
        self._heading = _Heading(start.yaw_rad)
        self.remaining = Remaining(angle_rad=angle_rad)

    def velocity(self, odometry: Pose) -> Velocity | None:
        """See `Law`."""
        left_rad = self._angle_rad - self._heading.update(odometry.yaw_rad)
        self.remaining = Remaining(abs(self._radius_m * left_rad), left_rad)
        if abs(left_rad) <= _TURN_TOLERANCE_RAD:
            return None
        rate = _falling(left_rad, self._largest_rad_s, _LEAST_TURN_RAD_S, _TURN_TIME_S)
        return Velocity(abs(rate) * self._radius_m, rate)


TURNING_TO_POSITION, DRIVING, TURNING_TO_HEADING = 1, 2, 3
"""Parts of the way to a pose, in order."""


class ToPose:
    """Turn towards a position, drive there, and turn to a heading if one is wanted."""

    def __init__(
        self,
        start: Pose,
        goal: Pose,
        *,
        with_heading: bool = True,
        largest_m_s: float = MAX_SPEED_M_S,
        largest_rad_s: float = MAX_TURN_RAD_S,
    ) -> None:
        """`start`, `goal`: by odometry. Speeds above 0 are limited to those of the robot."""
        self._goal, self._with_heading = goal, with_heading
        self._largest_m_s = min(largest_m_s, MAX_SPEED_M_S)
        self._largest_rad_s = min(largest_rad_s, MAX_TURN_RAD_S)
        distance_m = math.hypot(goal.x_m - start.x_m, goal.y_m - start.y_m)
        self.part = TURNING_TO_POSITION if distance_m > _DRIVE_TOLERANCE_M else TURNING_TO_HEADING
        """The part of the way: TURNING_TO_POSITION, DRIVING or TURNING_TO_HEADING."""
        self.remaining = Remaining(distance_m, 0.0)

    def velocity(self, odometry: Pose) -> Velocity | None:
        """See `Law`."""
        dx, dy = self._goal.x_m - odometry.x_m, self._goal.y_m - odometry.y_m
        distance_m = math.hypot(dx, dy)
        off_rad = wrap_angle(math.atan2(dy, dx) - odometry.yaw_rad)
        if self.part == TURNING_TO_POSITION:
            self.remaining = Remaining(distance_m, off_rad)
            if abs(off_rad) > _TURN_TOLERANCE_RAD:
                return self._turn(off_rad)
            self.part = DRIVING
        if self.part == DRIVING:
            self.remaining = Remaining(distance_m, off_rad)
            has_passed = distance_m < _NEAR_M and abs(off_rad) > math.pi / 2
            if distance_m > _DRIVE_TOLERANCE_M and not has_passed:
                if abs(off_rad) > _ASIDE_RAD and distance_m >= _NEAR_M:
                    return self._turn(off_rad)
                speed = _falling(distance_m, self._largest_m_s, _LEAST_DRIVE_M_S, _DRIVE_TIME_S)
                rate = _HEADING_GAIN * off_rad if distance_m >= _NEAR_M else 0.0
                return Velocity(speed, math.copysign(min(abs(rate), self._largest_rad_s), rate))
            self.part = TURNING_TO_HEADING
        left_rad = wrap_angle(self._goal.yaw_rad - odometry.yaw_rad) if self._with_heading else 0.0
        self.remaining = Remaining(0.0, left_rad)
        return None if abs(left_rad) <= _TURN_TOLERANCE_RAD else self._turn(left_rad)

    def _turn(self, left_rad: float) -> Velocity:
        return Velocity(0.0, _falling(left_rad, self._largest_rad_s, _LEAST_TURN_RAD_S, _TURN_TIME_S))


@dataclass(slots=True)
class StallDetector:
    """Notices that something holds a robot: for a second its wheels cover less than a fifth of what is wanted."""

    last: Pose
    _ticks: int = 0
    _wanted_m: float = 0.0
    _covered_m: float = 0.0
    _held: int = field(default=0)

    _WINDOW_TICKS = 50
    _WINDOWS = 2
    _SHARE = 0.2

    def update(self, odometry: Pose, wanted: Velocity) -> bool:
        """Whether the robot is held, after a tick in which it should have had a velocity."""
        dx, dy = odometry.x_m - self.last.x_m, odometry.y_m - self.last.y_m
        turn = wrap_angle(odometry.yaw_rad - self.last.yaw_rad)
        self.last = odometry
        self._covered_m += math.hypot(dx, dy) + abs(turn) * WHEEL_TRACK_M / 2
        self._wanted_m += (abs(wanted.linear_m_s) + abs(wanted.angular_rad_s) * WHEEL_TRACK_M / 2) * _TICK_S
        self._ticks += 1
        if self._ticks == self._WINDOW_TICKS:
            is_held = self._covered_m < self._SHARE * self._wanted_m
            self._held = self._held + 1 if is_held else 0
            self._ticks, self._wanted_m, self._covered_m = 0, 0.0, 0.0
        return self._held >= self._WINDOWS
