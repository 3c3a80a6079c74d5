"""The playground as an occupancy grid for path planners: occupied where a solid is or no floor is, otherwise free."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.model.geometry import Point
from thymio_sim_ros.sim.model.primitives import Disc, Floor, Solid

__all__ = ["CELL_M", "Grid", "grid"]

CELL_M = 0.01
"""Side of a cell in m; larger if the playground would have more than `MOST_CELLS` cells along an axis."""
MOST_CELLS = 2000

Cells = npt.NDArray[np.bool_]
Values = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Grid:
    """Cells row by row from the lower left `corner` (m in the world's frame); true where occupied."""

    corner: Point
    cell_m: float
    columns: int
    rows: int
    occupied: tuple[bool, ...]


def grid(floors: Sequence[Floor], solids: Sequence[Solid]) -> Grid:
    """The grid of floors and solids; a cell is occupied if its center is. Empty if there are neither."""
    corners = list(_corners(floors, solids))
    if not corners:
        return Grid((0.0, 0.0), CELL_M, 0, 0, ())
    xs, ys = zip(*corners, strict=True)
    left, bottom, width, height = min(xs), min(ys), max(xs) - min(xs), max(ys) - min(ys)
    cell = max(CELL_M, width / MOST_CELLS, height / MOST_CELLS)
    columns, rows = (max(1, math.ceil(round(length / cell, 6))) for length in (width, height))
    x = left + (np.arange(columns) + 0.5) * cell
    y = bottom + (np.arange(rows) + 0.5)[:, None] * cell
    cells: Cells = np.ones((rows, columns), dtype=bool)
    for floor in floors:
        cells &= ~_inside(x, y, floor.vertices)
    for solid in solids:
        if isinstance(solid.outline, Disc):
            cells |= (x - solid.pose.x_m) ** 2 + (y - solid.pose.y_m) ** 2 <= solid.outline.radius_m**2
        else:
            cells |= _inside(x, y, solid.vertices)
    return Grid((left, bottom), cell, columns, rows, tuple(cells.ravel().tolist()))


def _corners(floors: Iterable[Floor], solids: Iterable[Solid]) -> Iterator[Point]:
    for floor in floors:
        yield from floor.vertices
    for solid in solids:
        yield from solid.vertices
        if isinstance(solid.outline, Disc):
            radius, pose = solid.outline.radius_m, solid.pose
            yield (pose.x_m - radius, pose.y_m - radius)
            yield (pose.x_m + radius, pose.y_m + radius)


def _inside(x: Values, y: Values, vertices: Sequence[Point]) -> Cells:
    """Mask of the points in a convex counter-clockwise polygon, left of every side, shape (rows, columns)."""
    inside: Cells = np.ones((len(y), len(x)), dtype=bool)
    for (ax, ay), (bx, by) in zip(vertices, (*vertices[1:], vertices[0]), strict=True):
        inside &= (bx - ax) * (y - ay) - (by - ay) * (x - ax) >= -1e-9
    return inside
