"""The action to follow a wall by the proximity sensors, with the type of Create 3."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from thymio_sim_ros.ros.profiles import ActionRow, Ended, ProfileRobot
from thymio_sim_ros.ros.profiles._actions import MotorGuard
from thymio_sim_ros.sim.commands import BodyTwist

if TYPE_CHECKING:
    from thymio_sim_ros.sim.model.readings import ProximityReading

__all__ = ["WALL_FOLLOW"]

_SECOND_NS = 1_000_000_000
_LEFT, _CENTER_LEFT, _CENTER, _CENTER_RIGHT, _RIGHT = range(5)
_SPEED_M_S = 0.08
_WANTED_M = 0.05
"""Distance along the sensor on the side of the wall: the middle of the robot is 8 cm from it."""
_FRONT_M, _CLEAR_M = 0.07, 0.12
"""Distances in front at which it begins to turn away, and is clear."""
_GAIN, _LARGEST_RAD_S = 14.0, 1.2
_SEARCH_M_S, _SEARCH_RAD_S = 0.06, 0.9
"""Curve towards a wall that has ended: a circle of 7 cm."""


class _WallFollow:
    """Follows a wall on one side until the time is over."""

    def __init__(self, goal: Any, robot: ProfileRobot) -> None:
        runtime = goal.max_runtime
        self._runtime_ns = runtime.sec * _SECOND_NS + runtime.nanosec
        if goal.follow_side not in (1, -1):
            raise ValueError(f"follow_side is {goal.follow_side}, expected 1 (left) or -1 (right)")
        if self._runtime_ns <= 0:
            raise ValueError(f"max_runtime is {self._runtime_ns / _SECOND_NS:g} s, expected a time above 0")
        self._robot, self._side = robot, float(goal.follow_side)
        self._guard = MotorGuard(robot)
        self._start_ns = robot.world.now_ns
        self._is_engaged = self._is_turning = self._has_met_wall = False

    def step(self) -> Ended | None:
        """See `Motion`."""
        if (ended := self._guard.check()) is not None:
            return ended
        if self._robot.world.now_ns - self._start_ns >= self._runtime_ns:
            return Ended()
        self._guard.drive(self._twist())
        return None

    def feedback(self, kind: type[Any]) -> Any:
        """See `Motion`."""
        return kind(engaged=self._is_engaged)

    def result(self, kind: type[Any]) -> Any:
        """See `Motion`: for how long it drove."""
        message, passed_ns = kind(), self._robot.world.now_ns - self._start_ns
        message.runtime.sec, message.runtime.nanosec = divmod(passed_ns, _SECOND_NS)
        return message

    def stop(self) -> None:
        """See `Motion`."""
        self._guard.stop()

    def _twist(self) -> BodyTwist:
        reading: ProximityReading | None = self._robot.read("proximity")  # type: ignore[assignment]
        ranges = (math.inf,) * 7 if reading is None else reading.ranges_m
        outer, inner = (_LEFT, _CENTER_LEFT) if self._side > 0 else (_RIGHT, _CENTER_RIGHT)
        side_m, front_m = ranges[outer], min(ranges[_CENTER], ranges[inner])
        self._is_turning = front_m < (_CLEAR_M if self._is_turning else _FRONT_M)
        has_wall = self._is_turning or math.isfinite(side_m)
        self._has_met_wall = self._has_met_wall or self._is_turning or side_m < _FRONT_M
        self._is_engaged = self._has_met_wall and has_wall
        if self._is_turning:
            return BodyTwist(0.0, -self._side * _SEARCH_RAD_S)
        if not self._has_met_wall:
            return BodyTwist(_SPEED_M_S, 0.0)
        if not has_wall:
            return BodyTwist(_SEARCH_M_S, self._side * _SEARCH_RAD_S)
        turn = min(max(_GAIN * (side_m - _WANTED_M), -_LARGEST_RAD_S), _LARGEST_RAD_S)
        return BodyTwist(_SPEED_M_S, self._side * turn)


WALL_FOLLOW = ActionRow(
    "wall_follow",
    "irobot_create_msgs/action/WallFollow",
    _WallFollow,
    "drive straight to a wall, and along it on the left (1) or right (-1), until the time is over",
)
