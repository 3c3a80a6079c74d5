"""The area of the floors, and the distance to its edge.

A playground without any floor has no edges: its ground is infinite, though the ground sensors do not see it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from thymio_sim_ros.sim.model.geometry import Point
from thymio_sim_ros.sim.model.primitives import Floor
from thymio_sim_ros.sim.model.spatial_grid import SpatialGrid

__all__ = ["FloorSupport", "nearest_floor"]

_Sides = tuple[tuple[float, float, float], ...]
"""A convex polygon as sides (nx, ny, c): inside where n·p <= c."""


class FloorSupport:
    """The floors of a playground."""

    def __init__(self, floors: Sequence[Floor]) -> None:
        self._is_endless = not floors
        self._floors: SpatialGrid[_Sides] = SpatialGrid()
        for floor in floors:
            xs, ys = [x for x, _ in floor.vertices], [y for _, y in floor.vertices]
            self._floors.add(_sides(floor.vertices), (min(xs), min(ys), max(xs), max(ys)))

    def clearance_m(self, x_m: float, y_m: float) -> float:
        """A lower bound of the distance from a point to the edge of the floor, in m; below 0 if there is no floor."""
        if self._is_endless:
            return math.inf
        largest = -math.inf
        for sides in self._floors.near((x_m, y_m, x_m, y_m)):
            largest = max(largest, min(c - nx * x_m - ny * y_m for nx, ny, c in sides))
        return largest


def nearest_floor(floors: Sequence[Floor], point: Point) -> tuple[Floor, Point]:
    """The floor that is nearest to a point outside of all floors, and the place on its edge, in m."""
    places = [
        (floor, _nearest_on_edge(floor.vertices[index - 1], vertex, point))
        for floor in floors
        for index, vertex in enumerate(floor.vertices)
    ]
    return min(places, key=lambda place: math.dist(place[1], point))


def _nearest_on_edge(begin: Point, end: Point, point: Point) -> Point:
    (ax, ay), (bx, by), (px, py) = begin, end, point
    length_2 = (bx - ax) ** 2 + (by - ay) ** 2
    share = 0.0 if length_2 == 0.0 else ((px - ax) * (bx - ax) + (py - ay) * (by - ay)) / length_2
    share = min(max(share, 0.0), 1.0)
    return ax + share * (bx - ax), ay + share * (by - ay)


def _sides(vertices: Sequence[Point]) -> _Sides:
    sides = []
    for index, (bx, by) in enumerate(vertices):
        ax, ay = vertices[index - 1]
        length = math.hypot(bx - ax, by - ay)
        if length > 0.0:
            nx, ny = (by - ay) / length, (ax - bx) / length
            sides.append((nx, ny, nx * ax + ny * ay))
    return tuple(sides)
