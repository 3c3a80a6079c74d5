"""A file of things by place: a square grid in which each thing lies wherever its bounds touch."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import product
from typing import Generic, TypeVar

__all__ = ["CELL_SIDE_M", "Bounds", "Cell", "SpatialGrid", "cell_of"]

T = TypeVar("T")

CELL_SIDE_M = 0.5
_MAX_CELLS = 400
"""What touches more squares than this is found everywhere."""

Bounds = tuple[float, float, float, float]
"""Left, bottom, right, top."""
Cell = tuple[int, int]


def cell_of(x_m: float, y_m: float) -> Cell:
    """The square that holds a place."""
    return math.floor(x_m / CELL_SIDE_M), math.floor(y_m / CELL_SIDE_M)


class SpatialGrid(Generic[T]):
    """Things by place. Invariant: a query never misses a thing whose bounds meet its own."""

    def __init__(self) -> None:
        self._everywhere: list[T] = []
        self._cells: dict[Cell, list[T]] = {}

    def add(self, thing: T, bounds: Bounds) -> None:
        """File a thing."""
        columns, rows = _touched(bounds)
        if len(columns) * len(rows) > _MAX_CELLS:
            self._everywhere.append(thing)
            return
        for cell in product(columns, rows):
            self._cells.setdefault(cell, []).append(thing)

    def near(self, bounds: Bounds) -> Iterator[T]:
        """What may meet these bounds, each thing once, in an order that depends on the past alone."""
        columns, rows = _touched(bounds)
        found = dict.fromkeys(self._everywhere)
        wanted = self._cells if len(columns) * len(rows) > len(self._cells) else product(columns, rows)
        for cell in wanted:
            found.update(dict.fromkeys(self._cells.get(cell, ())))
        return iter(found)


def _touched(bounds: Bounds) -> tuple[range, range]:
    """Columns and rows of the squares that bounds touch."""
    left, bottom = cell_of(bounds[0], bounds[1])
    right, top = cell_of(bounds[2], bounds[3])
    return range(left, right + 1), range(bottom, top + 1)
