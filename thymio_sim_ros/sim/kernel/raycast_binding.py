"""Binding of the ray cast kernel for the fan of one sensor on a fixed set of robots."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.kernel import raycast_kernel
from thymio_sim_ros.sim.kernel.memory import KernelMemory

__all__ = ["FanArrays", "RaycastBinding"]

Values = npt.NDArray[np.float64]
Indices = npt.NDArray[np.intp]
Numbers = npt.NDArray[np.int32]

_SPARE = 2
"""Factor by which more pairs and planes are allocated than needed, so that a growing list seldom needs new memory."""
_FEW = 64
"""Smallest number of pairs or planes that are allocated."""


class FanArrays(Protocol):
    """What the kernel needs of a fan (`raycast.batch.Fan`, which is above this room)."""

    places: Values
    directions: Values
    axes: Values
    cos: Values
    sin: Values
    range_m: float
    reach_m: float
    is_narrow: bool


class RaycastBinding:
    """The arrays of the ray cast kernel for one fan and a fixed number of robots and obstacles.

    `begin` sets the candidates; `cast` may be called as long as it does not return None.
    """

    def __init__(
        self, fan: FanArrays, robots: int, things: int, fixed: int, hull: Sequence[float], most_m: float
    ) -> None:
        """Store the sizes; memory is allocated by `begin`.

        Args:
            fan: sensors and rays.
            robots: number of robots.
            things: number of obstacles, fixed and loose.
            fixed: number of fixed obstacles.
            hull: frame of a hull: x and y of its middle, cosine and sine of its heading, half size along and across.
            most_m: how far anything may move along an axis before the candidates are stale.
        """
        self._fan, self._robots, self._things, self._fixed = fan, robots, things, fixed
        self._sizes = (fan.range_m, fan.reach_m, most_m, *hull)
        self._room = (0, 0)
        """Number of pairs and of planes that there is memory for."""

    def begin(
        self,
        frames: Values,
        kinds: Indices,
        polygons: Sequence[Values],
        robot: Indices,
        thing: Indices,
        places: Values,
    ) -> None:
        """Set the candidate pairs.

        Args:
            frames: frames of obstacles and robots, shape (obstacles + robots, 7).
            kinds: their kinds, shape (obstacles + robots,).
            polygons: half planes of each polygon, shape (sides, 3); the hull is the last.
            robot: robots of the pairs, ascending.
            thing: obstacles of the pairs.
            places: positions of loose obstacles and robots now, shape (loose + robots, 2).
        """
        planes = np.concatenate(polygons)
        if len(thing) > self._room[0] or len(planes) > self._room[1]:
            self._room = (max(_FEW, _SPARE * len(thing)), max(_FEW, _SPARE * len(planes)))
            self._allocate()
        self._table[:] = frames
        self._kinds[:] = kinds
        self._plane_rows[: len(planes)] = planes
        self._side_numbers[: len(polygons) + 1] = np.cumsum([0, *map(len, polygons)])
        # The pairs are sorted by robot: those of robot r are first[r] to first[r + 1].
        self._first[0] = 0
        np.cumsum(np.bincount(robot, minlength=self._robots), out=self._first[1:])
        self._near[: len(thing)] = thing
        self._was[:] = places

    def cast(self, poses: Values, rows: Values) -> tuple[Indices, Values] | None:
        """Cast all rays for robots at `poses`, shape (robots, 3), and obstacles with these rows, shape (obstacles, 7).

        Returns what `BatchRaycaster.cast` returns, or None if the candidates are stale or were never set.
        """
        if self._room[0] == 0:
            return None
        self._poses[:] = poses
        self._table[: self._things] = rows
        np.cos(poses[:, 2], out=self._turns[0])
        np.sin(poses[:, 2], out=self._turns[1])
        self._call()
        seen, is_stale = self._counts[-2:].tolist()
        if is_stale:
            return None
        return self._numbers[:seen].astype(np.intp), self._distances[:seen].copy()

    def _allocate(self) -> None:
        """Allocate memory for the pairs and planes of `_room`, and bind the kernel to it."""
        pairs, planes = self._room
        fan, robots = self._fan, self._robots
        sensors, count = fan.directions.shape[1:]
        given = (fan.places, fan.axes, np.stack((fan.cos, fan.sin)), fan.directions)
        loose = self._things - self._fixed
        total = self._things + robots
        floats = [(len(self._sizes),), *(part.shape for part in given)]
        floats += [(robots, 3), (2, robots), (total, 7), (loose + robots, 2), (planes, 3), (robots * sensors, count)]
        ints = [(len(raycast_kernel.COUNTS),), (total,), (robots + 1,), (pairs,), (planes + 1,), (robots * sensors,)]
        memory, float_arrays, int_arrays = KernelMemory.holding(floats, ints)
        sizes, *fixed, poses, turns, frames, was, plane_rows, distances = float_arrays
        counts, kinds, first, near, side_numbers, numbers = int_arrays
        sizes[:] = self._sizes
        for part, values in zip(fixed, given, strict=True):
            part[:] = values
        counts[:6] = robots, sensors, count, self._things, self._fixed, fan.is_narrow
        self._memory = memory
        self._poses, self._turns, self._table, self._was = poses, turns, frames, was
        self._plane_rows, self._distances = plane_rows, distances
        self._counts, self._kinds, self._first, self._near = counts, kinds, first, near
        self._side_numbers, self._numbers = side_numbers, numbers
        self._call = memory.bind(
            raycast_kernel.cast,
            counts,
            sizes,
            *fixed,
            poses,
            turns,
            frames,
            was,
            kinds,
            first,
            near,
            plane_rows,
            side_numbers,
            numbers,
            distances,
        )
