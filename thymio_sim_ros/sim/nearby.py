"""Which obstacles are near a place, without looking at all of them.

Fixed ones are filed once, by the squares of a grid that their bounds touch; what moves is filed anew, by the square of
its middle, whenever it may have moved. A query costs what is near, however large the world and the crowd are.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from itertools import product
from typing import Protocol

from thymio_sim_ros.sim.geometry import Pose
from thymio_sim_ros.sim.rays import Obstacle

__all__ = ["Mover", "Nearby"]

_SQUARE_M = 0.5
_MOST_SQUARES = 400
"""What touches more squares is looked at in every query."""

_Square = tuple[int, int]


class Mover(Protocol):
    """Something that moves: a robot, a movable, a door."""

    @property
    def pose(self) -> Pose:
        """Where it is."""
        ...

    @property
    def reach_m(self) -> float:
        """No part of it is farther from its origin."""
        ...

    @property
    def obstacle(self) -> Obstacle:
        """What rays see of it there."""
        ...


class Nearby:
    """A file of obstacles by place. Invariant: after `stir` and before the next move it holds every mover's place."""

    def __init__(self, fixed: Iterable[Obstacle]) -> None:
        self._everywhere: list[Obstacle] = []
        self._fixed: dict[_Square, list[Obstacle]] = {}
        self._found: dict[tuple[_Square, float], tuple[Obstacle, ...]] = {}
        for obstacle in fixed:
            columns, rows = _squares(*obstacle.bounds)
            if len(columns) * len(rows) > _MOST_SQUARES:
                self._everywhere.append(obstacle)
                continue
            for square in product(columns, rows):
                self._fixed.setdefault(square, []).append(obstacle)
        self._movers: tuple[Mover, ...] = ()
        self._filed: dict[_Square, list[Mover]] | None = None
        self._longest_m = 0.0

    def replace_movers(self, movers: Iterable[Mover]) -> None:
        """From now on these move, and no others."""
        self._movers = tuple(movers)
        self._longest_m = max((mover.reach_m for mover in self._movers), default=0.0)
        self._filed = None

    def stir(self) -> None:
        """Movers may have moved."""
        self._filed = None

    def fixed(self, x_m: float, y_m: float, reach_m: float) -> tuple[Obstacle, ...]:
        """Fixed obstacles that may be nearer to a place than `reach_m`; never one too few."""
        square = (math.floor(x_m / _SQUARE_M), math.floor(y_m / _SQUARE_M))
        found = self._found.get((square, reach_m))
        if found is None:
            x, y = square[0] * _SQUARE_M, square[1] * _SQUARE_M
            area = _squares(x - reach_m, y - reach_m, x + _SQUARE_M + reach_m, y + _SQUARE_M + reach_m)
            near = dict.fromkeys(self._everywhere)
            is_wide = len(area[0]) * len(area[1]) > len(self._fixed)
            for neighbour in self._fixed if is_wide else product(*area):
                near.update(dict.fromkeys(self._fixed.get(neighbour, ())))
            found = self._found[square, reach_m] = tuple(near)
        return found

    def movers(self, x_m: float, y_m: float, reach_m: float) -> Iterator[Mover]:
        """What moves and may be nearer to a place than `reach_m`; never one too few."""
        far = reach_m + self._longest_m
        columns, rows = _squares(x_m - far, y_m - far, x_m + far, y_m + far)
        if len(columns) * len(rows) > len(self._movers):
            found: Iterable[Mover] = self._movers
        else:
            filed = self._file()
            found = (mover for square in product(columns, rows) for mover in filed.get(square, ()))
        for mover in found:
            if math.hypot(mover.pose.x_m - x_m, mover.pose.y_m - y_m) <= reach_m + mover.reach_m:
                yield mover

    def _file(self) -> dict[_Square, list[Mover]]:
        if self._filed is None:
            self._filed = {}
            for mover in self._movers:
                square = (math.floor(mover.pose.x_m / _SQUARE_M), math.floor(mover.pose.y_m / _SQUARE_M))
                self._filed.setdefault(square, []).append(mover)
        return self._filed


def _squares(left: float, bottom: float, right: float, top: float) -> tuple[range, range]:
    """The squares that an area touches: columns and rows."""
    columns = range(math.floor(left / _SQUARE_M), math.floor(right / _SQUARE_M) + 1)
    return columns, range(math.floor(bottom / _SQUARE_M), math.floor(top / _SQUARE_M) + 1)
