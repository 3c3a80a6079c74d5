"""Which obstacles are near a place, without looking at all of them.

Fixed ones are filed once; what moves is filed anew, by the square of its middle, whenever it may have moved. A query
costs what is near, however large the world and the crowd are.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from itertools import product
from typing import Protocol

from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.spatial_grid import SIDE_M, Square, Squares, square_of
from thymio_sim_ros.sim.raycast.scalar import Obstacle

__all__ = ["Mover", "Nearby"]


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
        self._fixed: Squares[Obstacle] = Squares()
        for obstacle in fixed:
            self._fixed.add(obstacle, obstacle.bounds)
        self._found: dict[tuple[Square, float], tuple[Obstacle, ...]] = {}
        self._movers: tuple[Mover, ...] = ()
        self._filed: dict[Square, list[Mover]] | None = None
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
        square = square_of(x_m, y_m)
        found = self._found.get((square, reach_m))
        if found is None:
            left, bottom = square[0] * SIDE_M - reach_m, square[1] * SIDE_M - reach_m
            wide = SIDE_M + 2 * reach_m
            found = self._found[square, reach_m] = tuple(self._fixed.near((left, bottom, left + wide, bottom + wide)))
        return found

    def movers(self, x_m: float, y_m: float, reach_m: float) -> Iterator[Mover]:
        """What moves and may be nearer to a place than `reach_m`; never one too few."""
        far = reach_m + self._longest_m
        left, bottom = square_of(x_m - far, y_m - far)
        right, top = square_of(x_m + far, y_m + far)
        found: Iterable[Mover] = self._movers
        if (right + 1 - left) * (top + 1 - bottom) <= len(self._movers):
            filed = self._file()
            squares = product(range(left, right + 1), range(bottom, top + 1))
            found = (mover for square in squares for mover in filed.get(square, ()))
        for mover in found:
            if math.hypot(mover.pose.x_m - x_m, mover.pose.y_m - y_m) <= reach_m + mover.reach_m:
                yield mover

    def _file(self) -> dict[Square, list[Mover]]:
        if self._filed is None:
            self._filed = {}
            for mover in self._movers:
                self._filed.setdefault(square_of(mover.pose.x_m, mover.pose.y_m), []).append(mover)
        return self._filed
