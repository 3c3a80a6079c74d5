"""Finds the robots of a batch that may reach something soon; the others need not be in pymunk's space.

A robot is bounded by the smallest circle around its hull, a moving object by a circle around its origin, a fixed
obstacle by a box. Sweep and prune: all are sorted by x, and only neighbors are compared.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.kernel import broadphase_kernel
from thymio_sim_ros.sim.kernel.memory import KernelMemory, is_available
from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.physics.time_to_contact import MAX_TICK_DISTANCE_M, OBJECT_SPEED_FACTOR, SAFETY_MARGIN_M
from thymio_sim_ros.sim.raycast.obstacle_table import ObstacleTable
from thymio_sim_ros.sim.raycast.scalar import Obstacle

__all__ = ["CHECK_INTERVAL_TICKS", "BroadphaseBatch"]

Values = npt.NDArray[np.float64]
Flags = npt.NDArray[np.bool_]

CHECK_INTERVAL_TICKS = 8
"""A robot that is not near anything stays so for this many ticks."""
_INTERVAL_DISTANCE_M = CHECK_INTERVAL_TICKS * MAX_TICK_DISTANCE_M


def _circle() -> tuple[float, float]:
    """The circle round the hull: how far its middle, on the x axis, is from the origin, and its radius."""
    half = robot_constants.HULL_WIDTH_M / 2
    front, rear = robot_constants.HULL_RADIUS_M, robot_constants.HULL_REAR_X_M
    middle = (front**2 - rear**2 - half**2) / (2 * (front - rear))
    return middle, front - middle


_MIDDLE_M, _RADIUS_M = _circle()
_OBJECT_REACH_M = _RADIUS_M + (1.0 + OBJECT_SPEED_FACTOR) * _INTERVAL_DISTANCE_M + SAFETY_MARGIN_M
_ROBOT_REACH_M = 2 * (_RADIUS_M + _INTERVAL_DISTANCE_M) + SAFETY_MARGIN_M
"""What is beyond this from a thing's circle, or from another robot, is not near."""


class BroadphaseBatch:
    """The broadphase of a batch: fixed obstacles are given once, robots and objects with every query."""

    def __init__(self, fixed: Sequence[Obstacle], *, is_compiled: bool | None = None) -> None:
        """`is_compiled`: by a kernel, or with numpy; None: by a kernel where there is one. Nothing else differs."""
        self._is_compiled = is_available() if is_compiled is None else is_compiled
        self._binding: _BroadphaseBinding | None = None
        rows = ObstacleTable(fixed).rows[:, :6]
        reach_m = np.full((len(rows), 1), _RADIUS_M + _INTERVAL_DISTANCE_M + SAFETY_MARGIN_M)
        x, y, cos, sin, half_x, half_y, far = self._fixed = np.concatenate((rows, reach_m), axis=1).T
        wide_x = np.abs(cos) * half_x + np.abs(sin) * half_y + far
        wide_y = np.abs(sin) * half_x + np.abs(cos) * half_y + far
        self._bounds = np.stack((x - wide_x, x + wide_x, y, wide_y))

    def near(self, poses: Values, stands: Flags, objects: Values) -> Flags:
        """Whether each robot may reach anything within `CHECK_INTERVAL_TICKS`, while doors rest and nothing is fast.

        `poses` has rows x, y, yaw, things rows x, y, radius; robots that do not stand are not there.
        """
        fixed, loose, count = self._fixed.shape[1], objects.shape[1], poses.shape[1]
        x, y, yaw = poses
        x, y = x + np.cos(yaw) * _MIDDLE_M, y + np.sin(yaw) * _MIDDLE_M
        if self._is_compiled:
            if self._binding is None or self._binding.room != (count, loose):
                self._binding = _BroadphaseBinding(self._fixed, self._bounds, count, loose)
            return self._binding.near(x, y, stands, objects)
        order = np.argsort(x, kind="stable")
        sorted_x = x[order]

        targets = np.zeros((7, fixed + loose + count))
        targets[2] = 1.0
        targets[:, :fixed] = self._fixed
        targets[:2, fixed : fixed + loose], targets[0, fixed + loose :], targets[1, fixed + loose :] = objects[:2], x, y
        reaches = targets[6]
        np.add(objects[2], _OBJECT_REACH_M, out=reaches[fixed : fixed + loose])
        np.multiply(stands, _ROBOT_REACH_M, out=reaches[fixed + loose :])
        left, right, middle, wide = bounds = np.empty((4, targets.shape[1]))
        bounds[:, :fixed] = self._bounds
        np.subtract(targets[0, fixed:], reaches[fixed:], out=left[fixed:])
        np.add(targets[0, fixed:], reaches[fixed:], out=right[fixed:])
        middle[fixed:], wide[fixed:] = targets[1, fixed:], reaches[fixed:]

        first = sorted_x.searchsorted(left)
        counts = sorted_x.searchsorted(right, side="right") - first
        target = np.arange(len(counts)).repeat(counts)
        robot = order[np.arange(len(target)) + (first - counts.cumsum() + counts)[target]]
        is_near = np.abs(y[robot] - middle[target]) <= wide[target]
        is_near &= target - (fixed + loose) != robot
        target, robot = target[is_near], robot[is_near]

        tx, ty, cos, sin, half_x, half_y, far = targets[:, target]
        dx, dy = x[robot] - tx, y[robot] - ty
        along = np.maximum(np.abs(cos * dx + sin * dy) - half_x, 0.0)
        across = np.maximum(np.abs(cos * dy - sin * dx) - half_y, 0.0)
        found = np.zeros(count, dtype=bool)
        found[robot[along * along + across * across < far * far]] = True
        found &= stands
        return found


class _BroadphaseBinding:
    """The kernel for so many robots and things: its arrays, and how it is called."""

    def __init__(self, fixed: Values, bounds: Values, robots: int, objects: int) -> None:
        floats = [(2,), (robots,), (robots,), fixed.shape, bounds.shape, (3, objects)]
        ints = [(len(broadphase_kernel.COUNTS),), (robots,), (robots,), (robots,)]
        memory, float_arrays, int_arrays = KernelMemory.holding(floats, ints)
        self.room = (robots, objects)
        sizes, self._x, self._y, own_fixed, own_bounds, self._objects = float_arrays
        counts, self._stands, order, self._found = int_arrays
        counts[:] = robots, fixed.shape[1], objects
        sizes[:] = _ROBOT_REACH_M, _OBJECT_REACH_M
        own_fixed[:], own_bounds[:], order[:] = fixed, bounds, np.arange(robots)
        self._memory = memory
        self._call = memory.bind(
            broadphase_kernel,
            broadphase_kernel.near,
            counts,
            sizes,
            self._x,
            self._y,
            self._stands,
            own_fixed,
            own_bounds,
            self._objects,
            order,
            self._found,
        )

    def near(self, x: Values, y: Values, stands: Flags, objects: Values) -> Flags:
        """As `BroadphaseBatch.near`, with the middles of the circles."""
        self._x[:], self._y[:], self._stands[:], self._objects[:] = x, y, stands, objects
        self._call()
        found: Flags = self._found.astype(bool)
        return found
