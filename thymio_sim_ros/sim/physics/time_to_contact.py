"""A lower bound of the time until a robot can touch anything; for so long it is integrated outside pymunk."""

from __future__ import annotations

import math

from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.physics.contact import TICK_S
from thymio_sim_ros.sim.physics.movable_body import MovableBody
from thymio_sim_ros.sim.physics.robot_body import RobotBody
from thymio_sim_ros.sim.raycast.broadphase import Broadphase

__all__ = ["MAX_TICK_DISTANCE_M", "OBJECT_SPEED_FACTOR", "SAFETY_MARGIN_M", "ticks_to_contact"]

MAX_TICK_DISTANCE_M = robot_constants.MAX_SPEED_M_S * TICK_S
"""Longest distance of a robot in a tick."""
SAFETY_MARGIN_M = 0.005
"""Safety margin of all distances."""
OBJECT_SPEED_FACTOR = 2.0
"""A pushed object moves at most this many times as far as a robot; otherwise it is fast (`MovableBody.is_fast`)."""
_MOST_TICKS = 100
_FAR_M = robot_constants.HULL_RADIUS_M + SAFETY_MARGIN_M + _MOST_TICKS * MAX_TICK_DISTANCE_M
"""Bodies farther away than this need no check."""


def ticks_to_contact(robot: RobotBody, broadphase: Broadphase, *, at_least: int, is_alone: bool) -> int:
    """Return the number of ticks in which the robot can touch nothing, whatever robots do; 0 if below `at_least`.

    This holds only while no door moves and no object is fast.

    Args:
        robot: the robot.
        broadphase: the obstacles around it.
        at_least: fewer ticks than this are not worth removing the robot from pymunk's space.
        is_alone: no other body moves, or could be moved by another robot.
    """
    # Conservative advancement: `free_m` is a lower bound of the distance that this robot can drive before it touches
    # anything. Bodies are bounded by circles, fixed obstacles by axis-parallel boxes.
    reach_m = robot_constants.HULL_RADIUS_M + SAFETY_MARGIN_M
    x, y = robot.pose.x_m, robot.pose.y_m
    free_m, least_m = _FAR_M - reach_m, at_least * MAX_TICK_DISTANCE_M
    for obstacle in broadphase.fixed(x, y, _FAR_M):
        left, bottom, right, top = obstacle.bounds
        free_m = min(free_m, math.hypot(max(left - x, 0.0, x - right), max(bottom - y, 0.0, y - top)) - reach_m)
        if free_m < least_m:
            return 0
    for mover in broadphase.movers(x, y, (1.0 + OBJECT_SPEED_FACTOR) * _FAR_M):
        if mover is robot:
            continue
        away_m = math.hypot(mover.pose.x_m - x, mover.pose.y_m - y) - mover.reach_m - reach_m
        # What moves toward the robot shares the gap in proportion to the speeds: another robot is as fast as this one,
        # a pushed object up to OBJECT_SPEED_FACTOR times as fast.
        if isinstance(mover, RobotBody):
            away_m /= 2
        elif isinstance(mover, MovableBody) and not is_alone:
            away_m /= 1.0 + OBJECT_SPEED_FACTOR
        free_m = min(free_m, away_m)
        if free_m < least_m:
            return 0
    return max(0, int(free_m / MAX_TICK_DISTANCE_M))
