"""Which of many robots may reach something soon; the others need no engine.

Robots are taken as the smallest circle round their hull, things that move as circles round their origins, things that
do not as the boxes round them. All of them are sorted by x; only those near each other are compared.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim import thymio2
from thymio_sim_ros.sim.frames import Frames
from thymio_sim_ros.sim.physics.quiet import LONGEST_WAY_M, SAFE_M, THING_SHARE
from thymio_sim_ros.sim.rays import Obstacle

__all__ = ["LOOK_ROUND_TICKS", "Lookout"]

Values = npt.NDArray[np.float64]
Flags = npt.NDArray[np.bool_]

LOOK_ROUND_TICKS = 8
"""What is not near stays out of reach for so many ticks."""
_WAY_M = LOOK_ROUND_TICKS * LONGEST_WAY_M


def _circle() -> tuple[float, float]:
    """The circle round the hull: how far its middle, on the x axis, is from the origin, and its radius."""
    half = thymio2.HULL_WIDTH_M / 2
    front, rear = thymio2.HULL_RADIUS_M, thymio2.HULL_REAR_X_M
    middle = (front**2 - rear**2 - half**2) / (2 * (front - rear))
    return middle, front - middle


_MIDDLE_M, _RADIUS_M = _circle()


class Lookout:
    """Looks round among fixed obstacles, which stay, robots and things, which are told."""

    def __init__(self, fixed: Sequence[Obstacle]) -> None:
        rows = Frames(fixed).rows[:, :6]
        reach_m = np.full((len(rows), 1), _RADIUS_M + _WAY_M + SAFE_M)
        self._fixed = np.concatenate((rows, reach_m), axis=1).T

    def near(self, poses: Values, stands: Flags, things: Values) -> Flags:
        """Who may reach anything within `LOOK_ROUND_TICKS`, while doors rest and nothing is fast.

        `poses` has rows x, y, yaw, things rows x, y, radius; robots that do not stand are not there.
        """
        count = poses.shape[1]
        x, y, yaw = poses
        x, y = x + np.cos(yaw) * _MIDDLE_M, y + np.sin(yaw) * _MIDDLE_M
        loose = np.zeros((7, things.shape[1] + count))
        loose[0], loose[1] = np.concatenate((things[0], x)), np.concatenate((things[1], y))
        loose[2] = 1.0
        loose[6, : things.shape[1]] = things[2] + (_RADIUS_M + (1.0 + THING_SHARE) * _WAY_M + SAFE_M)
        loose[6, things.shape[1] :] = np.where(stands, 2 * (_RADIUS_M + _WAY_M) + SAFE_M, 0.0)
        targets = np.concatenate((self._fixed, loose), axis=1)
        wide_x = np.abs(targets[2]) * targets[4] + np.abs(targets[3]) * targets[5] + targets[6]

        order = np.argsort(x, kind="stable")
        sorted_x = x[order]
        first = np.searchsorted(sorted_x, targets[0] - wide_x, side="left")
        counts = np.searchsorted(sorted_x, targets[0] + wide_x, side="right") - first
        target = np.repeat(np.arange(targets.shape[1]), counts)
        robot = order[np.arange(len(target)) + np.repeat(first - (np.cumsum(counts) - counts), counts)]

        tx, ty, cos, sin, half_x, half_y, reach = targets[:, target]
        dx, dy = x[robot] - tx, y[robot] - ty
        along = np.maximum(np.abs(cos * dx + sin * dy) - half_x, 0.0)
        across = np.maximum(np.abs(cos * dy - sin * dx) - half_y, 0.0)
        is_near = along * along + across * across < reach * reach
        is_near &= target - (targets.shape[1] - count) != robot
        found = np.zeros(count, dtype=bool)
        found[robot[is_near]] = True
        found &= stands
        return found
