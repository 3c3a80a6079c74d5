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
    """Return the smallest circle around the hull: distance of its center, on the x axis, from the origin, and radius.

    It passes through the front, at x = front, and the rear corners, at (rear, ±half). Center m and radius front - m
    follow from (front - m)² = (m - rear)² + half².
    """
    half = robot_constants.HULL_WIDTH_M / 2
    front, rear = robot_constants.HULL_RADIUS_M, robot_constants.HULL_REAR_X_M
    middle = (front**2 - rear**2 - half**2) / (2 * (front - rear))
    return middle, front - middle


_MIDDLE_M, _RADIUS_M = _circle()
_OBJECT_REACH_M = _RADIUS_M + (1.0 + OBJECT_SPEED_FACTOR) * _INTERVAL_DISTANCE_M + SAFETY_MARGIN_M
_ROBOT_REACH_M = 2 * (_RADIUS_M + _INTERVAL_DISTANCE_M) + SAFETY_MARGIN_M
"""Distances between the center of a robot and that of an object (less the object's radius), and of two robots, beyond
which they cannot touch before the next check. Two robots approach each other, so the distance counts twice."""


class BroadphaseBatch:
    """The broadphase of a batch: fixed obstacles are given once, robots and objects with every query."""

    def __init__(self, fixed: Sequence[Obstacle], *, is_compiled: bool | None = None) -> None:
        """Index the fixed obstacles.

        Args:
            fixed: obstacles that never move.
            is_compiled: whether to use kernels or numpy; None: kernels if available. The results are the same.
        """
        self._is_compiled = is_available() if is_compiled is None else is_compiled
        self._binding: _BroadphaseBinding | None = None
        rows = ObstacleTable(fixed).rows[:, :6]
        reach_m = np.full((len(rows), 1), _RADIUS_M + _INTERVAL_DISTANCE_M + SAFETY_MARGIN_M)
        # Bounds of each obstacle, enlarged by the reach: left and right, middle and half width in y.
        x, y, cos, sin, half_x, half_y, far = self._fixed = np.concatenate((rows, reach_m), axis=1).T
        wide_x = np.abs(cos) * half_x + np.abs(sin) * half_y + far
        wide_y = np.abs(sin) * half_x + np.abs(cos) * half_y + far
        self._bounds = np.stack((x - wide_x, x + wide_x, y, wide_y))

    def near(self, poses: Values, stands: Flags, objects: Values) -> Flags:
        """Return whether each robot may reach anything within `CHECK_INTERVAL_TICKS`, shape (robots,).

        This holds while doors rest and no object is fast.

        Args:
            poses: x, y, yaw of the robots, shape (3, robots).
            stands: whether each robot stands, shape (robots,); fallen robots reach nothing and are not reached.
            objects: x, y and radius in m of movable objects and doors, shape (3, objects).
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

        # Targets are fixed obstacles, objects and robots, in this order. Rows: x, y, cosine, sine, half size along and
        # across, reach; objects and robots are points with a reach. A robot that does not stand has a reach of 0.
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

        # Sweep and prune along x: robots first[t]…first[t] + counts[t] of the sorted order overlap target t. They are
        # expanded to one entry per pair (target, robot), as in `raycast.batch`, then filtered by y.
        first = sorted_x.searchsorted(left)
        counts = sorted_x.searchsorted(right, side="right") - first
        target = np.arange(len(counts)).repeat(counts)
        robot = order[np.arange(len(target)) + (first - counts.cumsum() + counts)[target]]
        is_near = np.abs(y[robot] - middle[target]) <= wide[target]
        is_near &= target - (fixed + loose) != robot  # a robot is no neighbor of itself
        target, robot = target[is_near], robot[is_near]

        # Exact test: distance from the center of the robot to the box of the target, in the frame of the box.
        tx, ty, cos, sin, half_x, half_y, far = targets[:, target]
        dx, dy = x[robot] - tx, y[robot] - ty
        along = np.maximum(np.abs(cos * dx + sin * dy) - half_x, 0.0)
        across = np.maximum(np.abs(cos * dy - sin * dx) - half_y, 0.0)
        found = np.zeros(count, dtype=bool)
        found[robot[along * along + across * across < far * far]] = True
        found &= stands
        return found


class _BroadphaseBinding:
    """The arrays and the call of the kernel for a fixed number of robots and objects."""

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
        """Return whether each robot may reach anything; x, y: centers of the robots' circles, shape (robots,)."""
        self._x[:], self._y[:], self._stands[:], self._objects[:] = x, y, stands, objects
        self._call()
        found: Flags = self._found.astype(bool)
        return found
