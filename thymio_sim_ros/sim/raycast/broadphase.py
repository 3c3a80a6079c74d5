"""Finds the obstacles near a point without testing all of them.

Fixed obstacles are put into a grid once. Moving bodies are put into the cell of their origin again whenever they may
have moved. The cost of a query depends on what is near, not on the size of the world.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from itertools import product
from typing import Protocol

from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.spatial_grid import CELL_SIDE_M, Cell, SpatialGrid, cell_of
from thymio_sim_ros.sim.raycast.scalar import Obstacle

__all__ = ["Broadphase", "Mover"]


class Mover(Protocol):
    """A moving body: a robot, an object or a door."""

    @property
    def pose(self) -> Pose:
        """Its pose."""
        ...

    @property
    def reach_m(self) -> float:
        """Largest distance of any of its points from its origin."""
        ...

    @property
    def obstacle(self) -> Obstacle:
        """Its obstacle for rays at this pose."""
        ...


class Broadphase:
    """A spatial index of obstacles.

    Queries for fixed obstacles are cached by the cell of the point: robots stay in a cell for many ticks.

    Invariant: after `invalidate_movers` and before the next move, queries see every mover where it is.
    """

    def __init__(self, fixed: Iterable[Obstacle]) -> None:
        self._fixed: SpatialGrid[Obstacle] = SpatialGrid()
        for obstacle in fixed:
            self._fixed.add(obstacle, obstacle.bounds)
        self._found: dict[tuple[Cell, float], tuple[Obstacle, ...]] = {}
        self._movers: tuple[Mover, ...] = ()
        self._cells: dict[Cell, list[Mover]] | None = None
        self._max_reach_m = 0.0

    def replace_movers(self, movers: Iterable[Mover]) -> None:
        """Replace the list of moving bodies."""
        self._movers = tuple(movers)
        self._max_reach_m = max((mover.reach_m for mover in self._movers), default=0.0)
        self._cells = None

    def invalidate_movers(self) -> None:
        """Note that movers may have moved."""
        self._cells = None

    def fixed(self, x_m: float, y_m: float, reach_m: float) -> tuple[Obstacle, ...]:
        """Return the fixed obstacles that may be within `reach_m` of a point; a superset."""
        cell = cell_of(x_m, y_m)
        found = self._found.get((cell, reach_m))
        if found is None:
            # The answer holds for every point of the cell: the cell, enlarged by the reach on all sides.
            left, bottom = cell[0] * CELL_SIDE_M - reach_m, cell[1] * CELL_SIDE_M - reach_m
            wide = CELL_SIDE_M + 2 * reach_m
            found = self._found[cell, reach_m] = tuple(self._fixed.near((left, bottom, left + wide, bottom + wide)))
        return found

    def movers(self, x_m: float, y_m: float, reach_m: float) -> Iterator[Mover]:
        """Iterate over the moving bodies that may be within `reach_m` of a point; a superset."""
        # A mover is in the cell of its origin only, so the search is widened by the largest reach of any mover.
        far = reach_m + self._max_reach_m
        left, bottom = cell_of(x_m - far, y_m - far)
        right, top = cell_of(x_m + far, y_m + far)
        found: Iterable[Mover] = self._movers
        # With fewer movers than cells, testing all movers is faster than visiting the cells.
        if (right + 1 - left) * (top + 1 - bottom) <= len(self._movers):
            filed = self._file()
            squares = product(range(left, right + 1), range(bottom, top + 1))
            found = (mover for cell in squares for mover in filed.get(cell, ()))
        for mover in found:
            if math.hypot(mover.pose.x_m - x_m, mover.pose.y_m - y_m) <= reach_m + mover.reach_m:
                yield mover

    def _file(self) -> dict[Cell, list[Mover]]:
        if self._cells is None:
            self._cells = {}
            for mover in self._movers:
                self._cells.setdefault(cell_of(mover.pose.x_m, mover.pose.y_m), []).append(mover)
        return self._cells
