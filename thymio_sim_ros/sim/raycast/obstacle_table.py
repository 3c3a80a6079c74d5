"""Obstacles as rows of arrays: a frame, the half size of the bounding box in that frame, and the exact outline.

Rays are transformed into the frame of an obstacle, where a box has only a half size and all hulls of robots are equal.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.raycast.scalar import DiscObstacle, Obstacle

__all__ = ["BOX", "DISC", "HEIGHT", "NOWHERE_M", "ObstacleTable", "Values", "polygon_in_frame"]

Values = npt.NDArray[np.float64]

DISC, BOX = -2, -1
"""Kinds; a number from 0 up is that of a polygon."""
HEIGHT = 6
"""Column of the height."""
NOWHERE_M = -1.0
"""Height of a missing obstacle."""
_RIGHT_ANGLE = 1e-9


class ObstacleTable:
    """Obstacles as arrays.

    Attributes:
        rows: shape (obstacles, 7): x and y of the middle, cosine and sine of the heading, half size along and across
            the heading, height; m.
        kinds: shape (obstacles,): DISC, BOX, or the index of the outline in `polygons`.
        polygons: half planes n·p <= c of each polygon in its frame, shape (sides, 3): nx, ny, c.
    """

    __slots__ = ("kinds", "polygons", "rows")

    def __init__(self, obstacles: Sequence[Obstacle | None]) -> None:
        self.rows = np.zeros((len(obstacles), 7))
        self.kinds = np.full(len(obstacles), BOX, dtype=np.intp)
        self.polygons: list[Values] = []
        for row, obstacle in enumerate(obstacles):
            self.put(row, obstacle)

    def put(self, row: int, obstacle: Obstacle | None) -> None:
        """Write an obstacle to a row; None for a missing one, which is lower than all rays."""
        if obstacle is None:
            self.rows[row, HEIGHT] = NOWHERE_M
            return
        place: tuple[float, float, float, float, float, float]
        if isinstance(obstacle, DiscObstacle):
            self.kinds[row] = DISC
            place = (obstacle.x_m, obstacle.y_m, 1.0, 0.0, obstacle.radius_m, obstacle.radius_m)
        else:
            place, planes = polygon_in_frame(obstacle.vertices)
            if planes is None:
                self.kinds[row] = BOX
            elif self.kinds[row] >= 0:
                self.polygons[self.kinds[row]] = planes
            else:
                self.kinds[row] = len(self.polygons)
                self.polygons.append(planes)
        self.rows[row] = (*place, obstacle.height_m)


def polygon_in_frame(
    vertices: Sequence[tuple[float, float]],
) -> tuple[tuple[float, float, float, float, float, float], Values | None]:
    """Return the frame of a convex polygon, and its half planes in this frame; None for them if it is a rectangle.

    The frame lies along the first side: x and y of the middle of the bounding box, cosine and sine of the heading, half
    size along and across. A polygon that moves keeps its half planes, and a rectangle is its own bounding box.
    """
    (ax, ay), (bx, by) = vertices[0], vertices[1]
    length = math.hypot(bx - ax, by - ay)
    cos, sin = (bx - ax) / length, (by - ay) / length
    along = [cos * x + sin * y for x, y in vertices]
    across = [cos * y - sin * x for x, y in vertices]
    half_x, half_y = (max(along) - min(along)) / 2, (max(across) - min(across)) / 2
    u, v = (max(along) + min(along)) / 2, (max(across) + min(across)) / 2
    place = (cos * u - sin * v, sin * u + cos * v, cos, sin, half_x, half_y)
    corners = [(x - u, y - v) for x, y in zip(along, across, strict=True)]
    if len(corners) == 4 and all(
        abs(abs(x) - half_x) < _RIGHT_ANGLE and abs(abs(y) - half_y) < _RIGHT_ANGLE for x, y in corners
    ):
        return place, None
    planes = []
    for (px, py), (qx, qy) in zip(corners, corners[1:] + corners[:1], strict=True):
        side = math.hypot(qx - px, qy - py)
        nx, ny = (qy - py) / side, (px - qx) / side
        planes.append((nx, ny, nx * px + ny * py))
    return place, np.array(planes)
