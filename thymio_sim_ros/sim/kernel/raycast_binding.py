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
"""There is room for so many times the pairs and planes that there are at first."""
_FEW = 64


class FanArrays(Protocol):
    """What a fan says of its sensors."""

    places: Values
    directions: Values
    axes: Values
    cos: Values
    sin: Values
    range_m: float
    reach_m: float
    is_narrow: bool


class RaycastBinding:
    """What is near, and what rays meet of it. Invariant: after `begin`, which says what is near."""

    def __init__(
        self, fan: FanArrays, robots: int, things: int, fixed: int, hull: Sequence[float], most_m: float
    ) -> None:
        """`hull`: middle, turn and half size of a robot in its frame; the list of what is near holds for `most_m`."""
        self._fan, self._robots, self._things, self._fixed = fan, robots, things, fixed
        self._sizes = (fan.range_m, fan.reach_m, most_m, *hull)
        self._room = (0, 0)
        """For pairs, and for planes."""

    def begin(
        self,
        frames: Values,
        kinds: Indices,
        polygons: Sequence[Values],
        robot: Indices,
        thing: Indices,
        places: Values,
    ) -> None:
        """What is near: pairs in the order of robots, found when loose things and robots were at `places`.

        `frames` and `kinds` are those of things and robots; a polygon's planes are rows of three, the last is the hull.
        """
        planes = np.concatenate(polygons)
        if len(thing) > self._room[0] or len(planes) > self._room[1]:
            self._room = (max(_FEW, _SPARE * len(thing)), max(_FEW, _SPARE * len(planes)))
            self._take()
        self._table[:] = frames
        self._kinds[:] = kinds
        self._plane_rows[: len(planes)] = planes
        self._side_numbers[: len(polygons) + 1] = np.cumsum([0, *map(len, polygons)])
        self._first[0] = 0
        np.cumsum(np.bincount(robot, minlength=self._robots), out=self._first[1:])
        self._near[: len(thing)] = thing
        self._was[:] = places

    def cast(self, poses: Values, rows: Values) -> tuple[Indices, Values] | None:
        """As `BatchRaycaster.cast`, of things with these `rows` now; None when what is near has to be found anew."""
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

    def _take(self) -> None:
        """Take memory and bind the kernel to it."""
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
