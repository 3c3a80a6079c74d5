"""For how long nothing can happen: while no robot is in reach of anything, the engine may rest."""

from __future__ import annotations

import math
from collections.abc import Iterable

from thymio_sim_ros.sim import thymio2
from thymio_sim_ros.sim.clock import TICK_NS
from thymio_sim_ros.sim.nearby import Nearby
from thymio_sim_ros.sim.physics.robots import RobotBody

__all__ = ["LOOK_ROUND_TICKS", "quiet_ticks"]

LOOK_ROUND_TICKS = 10
"""How often it is worth while to look round."""
_LONGEST_WAY_M = thymio2.MAX_SPEED_M_S * TICK_NS * 1e-9
_SAFE_M = 0.005
_MOST_TICKS = 100
_FAR_M = thymio2.HULL_RADIUS_M + _SAFE_M + _MOST_TICKS * _LONGEST_WAY_M
"""What is farther away does not shorten the quiet."""


def quiet_ticks(robots: Iterable[RobotBody], nearby: Nearby) -> int:
    """For how many ticks no robot can reach anything, however it drives; things and doors being at rest."""
    free_m = _FAR_M
    for robot in robots:
        x, y = robot.pose.x_m, robot.pose.y_m
        for obstacle in nearby.fixed(x, y, _FAR_M):
            left, bottom, right, top = obstacle.bounds
            free_m = min(free_m, math.hypot(max(left - x, 0.0, x - right), max(bottom - y, 0.0, y - top)))
        for mover in nearby.movers(x, y, 2 * _FAR_M):
            away_m = math.hypot(mover.pose.x_m - x, mover.pose.y_m - y)
            if not isinstance(mover, RobotBody):
                free_m = min(free_m, away_m - mover.reach_m)
            elif mover is not robot:
                free_m = min(free_m, away_m / 2)
    return max(0, int((free_m - thymio2.HULL_RADIUS_M - _SAFE_M) / _LONGEST_WAY_M))
