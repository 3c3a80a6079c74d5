"""A uniform grid: each item is in all cells that its bounds touch."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import product
from typing import Generic, TypeVar

__all__ = ["CELL_SIDE_M", "Bounds", "Cell", "SpatialGrid", "cell_of"]

T = TypeVar("T")

CELL_SIDE_M = 0.5
_MAX_CELLS = 400
"""An item that touches more cells than this is returned by every query."""

Bounds = tuple[float, float, float, float]
"""Left, bottom, right, top."""
Cell = tuple[int, int]


def cell_of(x_m: float, y_m: float) -> Cell:
    """The cell that contains a point."""
    return math.floor(x_m / CELL_SIDE_M), math.floor(y_m / CELL_SIDE_M)


class SpatialGrid(Generic[T]):
    """Items by position. Invariant: a query never misses an item whose bounds overlap its own."""

    def __init__(self) -> None:
        self._everywhere: list[T] = []
        self._cells: dict[Cell, list[T]] = {}

    def add(self, thing: T, bounds: Bounds) -> None:
        """Add an item."""
        columns, rows = _touched(bounds)
        if len(columns) * len(rows) > _MAX_CELLS:
            self._everywhere.append(thing)
            return
        for cell in product(columns, rows):
            self._cells.setdefault(cell, []).append(thing)

    def near(self, bounds: Bounds) -> Iterator[T]:
        """The items that may overlap these bounds, each once; their order depends only on the order of calls."""
        columns, rows = _touched(bounds)
        found = dict.fromkeys(self._everywhere)
        wanted = self._cells if len(columns) * len(rows) > len(self._cells) else product(columns, rows)
        for cell in wanted:
            found.update(dict.fromkeys(self._cells.get(cell, ())))
        return iter(found)


def _touched(bounds: Bounds) -> tuple[range, range]:
    """The columns and rows of the cells that bounds touch."""
    left, bottom = cell_of(bounds[0], bounds[1])
    right, top = cell_of(bounds[2], bounds[3])
    return range(left, right + 1), range(bottom, top + 1)
