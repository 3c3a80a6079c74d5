"""Obstacles as records: a frame, the half size of the bounding box in that frame, and the exact outline.

Rays are transformed into the frame of an obstacle, where a box has only a half size and all hulls of robots are equal.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from aseba_vm.kernel.record import Record
from aseba_vm.kernel.types import Floats, Ints
from thymio_sim_ros.sim.kernel.memory import KernelMemory
from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.raycast.scalar import DiscObstacle, Obstacle

__all__ = [
    "BOX",
    "DISC",
    "FAR_M",
    "HULL_FRAME",
    "NOWHERE_M",
    "ObstacleTable",
    "Obstacles",
    "Planes",
    "polygon_in_frame",
]

DISC, BOX, POLYGON = 0, 1, 2
"""Kinds of outlines."""
NOWHERE_M = -1.0
"""Height of a missing obstacle, below all rays."""
FAR_M = 1e6
"""A coordinate where nothing is."""
_RIGHT_ANGLE = 1e-9

Frame = tuple[float, float, float, float, float, float]


class Obstacles(Record):
    """All obstacles: those that never move, those that can move, robots."""

    x: Floats
    """Middle of the bounding box, m."""
    y: Floats
    cosine: Floats
    """Of the heading of the frame."""
    sine: Floats
    half_x: Floats
    """Half size along the heading, m."""
    half_y: Floats
    height: Floats
    """Height above the floor, m; NOWHERE_M if it is missing."""
    kind: Ints
    """DISC, BOX or POLYGON."""
    is_fixed: Ints
    """Whether it never moves."""
    first_plane: Ints
    """The half planes of a polygon are `first_plane` to `last_plane`, the end not included."""
    last_plane: Ints


class Planes(Record):
    """Half planes n·p <= c of polygons, with outward unit normals, in the frame of their obstacle."""

    normal_x: Floats
    normal_y: Floats
    limit: Floats


class ObstacleTable:
    """The records of all obstacles; those of robots are written by kernels."""

    def __init__(
        self, memory: KernelMemory, fixed: Sequence[Obstacle], loose: Sequence[Obstacle | None], robots: int
    ) -> None:
        """Allocate the records and write the obstacles.

        Args:
            memory: where the records are.
            fixed: obstacles that never move.
            loose: obstacles that can move, by number; None for a missing one.
            robots: number of robots.
        """
        self.first_loose, first_robot = len(fixed), len(fixed) + len(loose)
        hull, hull_planes = polygon_in_frame(robot_constants.hull())
        assert hull_planes is not None  # it is no box
        sides = [len(getattr(obstacle, "vertices", ())) for obstacle in (*fixed, *loose)]
        self.planes = Planes(memory, len(hull_planes) + sum(sides))
        self.obstacles = obstacles = Obstacles(memory, first_robot + robots)
        self._planes_used = 0
        obstacles.is_fixed[: self.first_loose] = 1
        hulls = slice(first_robot, None)
        obstacles.half_x[hulls], obstacles.half_y[hulls] = hull[4:]
        obstacles.kind[hulls] = POLYGON
        obstacles.first_plane[hulls], obstacles.last_plane[hulls] = self._add_planes(hull_planes)
        for row, obstacle in enumerate((*fixed, *loose)):
            self.put(row, obstacle)

    def put(self, row: int, obstacle: Obstacle | None) -> None:
        """Write an obstacle; None for a missing one, which is lower than all rays."""
        rows = self.obstacles.view
        rows.height[row] = NOWHERE_M if obstacle is None else obstacle.height_m
        if obstacle is None:
            return
        if isinstance(obstacle, DiscObstacle):
            rows.kind[row] = DISC
            frame: Frame = (obstacle.x_m, obstacle.y_m, 1.0, 0.0, obstacle.radius_m, obstacle.radius_m)
        else:
            frame, planes = polygon_in_frame(obstacle.vertices)
            if planes is None:
                rows.kind[row] = BOX
            elif rows.kind[row] != POLYGON:  # an obstacle that moves keeps its half planes
                rows.kind[row] = POLYGON
                rows.first_plane[row], rows.last_plane[row] = self._add_planes(planes)
        rows.x[row], rows.y[row], rows.cosine[row], rows.sine[row], rows.half_x[row], rows.half_y[row] = frame

    def _add_planes(self, planes: npt.NDArray[np.float64]) -> tuple[int, int]:
        first, self._planes_used = self._planes_used, self._planes_used + len(planes)
        part = slice(first, self._planes_used)
        self.planes.normal_x[part], self.planes.normal_y[part], self.planes.limit[part] = planes.T
        return first, self._planes_used


def polygon_in_frame(
    vertices: Sequence[tuple[float, float]],
) -> tuple[Frame, npt.NDArray[np.float64] | None]:
    """The frame of a convex polygon, and its half planes in this frame; None for them if it is a rectangle.

    The frame lies along the first side: x and y of the middle of the bounding box, cosine and sine of the heading, half
    size along and across. A polygon that moves keeps its half planes, rows nx, ny, c; a rectangle is its own bounding
    box.
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


HULL_FRAME = polygon_in_frame(robot_constants.hull())[0]
"""The frame of a robot's hull in the robot's frame."""
