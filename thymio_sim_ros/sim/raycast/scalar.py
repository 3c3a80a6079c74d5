"""Ray casts against convex obstacles, one by one; also the reference for the batch.

A convex polygon is the intersection of half planes n·p <= c with outward unit normals n. The ray o + t d crosses the
border of a half plane at t = (c - n·o) / (n·d): it enters the half plane there if n·d < 0, and leaves it if n·d > 0. It
is inside the polygon from the largest entering t to the smallest leaving t, if the former is not larger.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from thymio_sim_ros.sim.model.geometry import Point
from thymio_sim_ros.sim.model.primitives import Disc, Solid

__all__ = ["ConvexObstacle", "DiscObstacle", "Obstacle", "Surroundings", "obstacle_of"]


class ConvexObstacle:
    """A convex polygon in the world's frame.

    `vertices` are counter-clockwise, `bounds` are left, bottom, right and top, `planes` rows (nx, ny, c); all in m.
    """

    __slots__ = ("bounds", "height_m", "planes", "vertices")

    def __init__(self, vertices: Sequence[Point], height_m: float) -> None:
        self.height_m = height_m
        self.vertices = vertices
        xs, ys = [x for x, _ in vertices], [y for _, y in vertices]
        self.bounds = (min(xs), min(ys), max(xs), max(ys))
        planes = []
        for index, (bx, by) in enumerate(vertices):
            ax, ay = vertices[index - 1]
            length = math.hypot(bx - ax, by - ay)
            # Vertices are counter-clockwise, so the side turned by -90 degrees points outward.
            nx, ny = (by - ay) / length, (ax - bx) / length
            planes.append((nx, ny, nx * ax + ny * ay))
        self.planes = tuple(planes)

    def is_within(self, x_m: float, y_m: float, reach_m: float) -> bool:
        """Whether it may be nearer than `reach_m` to a point; true for some points that are not (at corners)."""
        for nx, ny, c in self.planes:  # noqa: SIM110  # the loop is twice as fast as all(...)
            if nx * x_m + ny * y_m - c > reach_m:
                return False
        return True

    def distance(self, x_m: float, y_m: float, dx: float, dy: float, limit_m: float) -> float:
        """The distance in m at which a ray enters the obstacle; `limit_m` if it does not before.

        The direction (dx, dy) has unit length. A ray that starts inside the obstacle does not enter it.
        """
        enter, leave = -math.inf, limit_m
        for nx, ny, c in self.planes:
            along = nx * dx + ny * dy
            room = c - nx * x_m - ny * y_m
            if along < 0.0:
                t = room / along
                if t > enter:
                    enter = t
            elif along > 0.0:
                t = room / along
                if t < leave:
                    leave = t
            elif room < 0.0:  # parallel to this side and outside of it
                return limit_m
        return enter if 0.0 <= enter <= leave else limit_m


class DiscObstacle:
    """A disc in the world's frame; `bounds` are left, bottom, right and top in m."""

    __slots__ = ("bounds", "height_m", "radius_m", "x_m", "y_m")

    def __init__(self, x_m: float, y_m: float, radius_m: float, height_m: float) -> None:
        self.x_m, self.y_m, self.radius_m, self.height_m = x_m, y_m, radius_m, height_m
        self.bounds = (x_m - radius_m, y_m - radius_m, x_m + radius_m, y_m + radius_m)

    def is_within(self, x_m: float, y_m: float, reach_m: float) -> bool:
        """Whether it is at most `reach_m` away from a point."""
        return math.hypot(self.x_m - x_m, self.y_m - y_m) <= reach_m + self.radius_m

    def distance(self, x_m: float, y_m: float, dx: float, dy: float, limit_m: float) -> float:
        """The distance in m at which a ray enters the obstacle; `limit_m` if it does not before.

        The direction (dx, dy) has unit length. A ray that starts inside the obstacle does not enter it.
        """
        px, py = self.x_m - x_m, self.y_m - y_m
        # The ray passes the center at t = middle, at a distance whose square is |p|² - middle². By Pythagoras it is
        # inside from middle - sqrt(square) to middle + sqrt(square); it misses the disc if `square` is negative.
        middle = px * dx + py * dy
        square = self.radius_m * self.radius_m - (px * px + py * py - middle * middle)
        if square < 0.0:
            return limit_m
        enter = middle - math.sqrt(square)
        return enter if 0.0 <= enter <= limit_m else limit_m


Obstacle = ConvexObstacle | DiscObstacle


def obstacle_of(solid: Solid) -> Obstacle:
    """The obstacle that a solid is for rays."""
    if isinstance(solid.outline, Disc):
        return DiscObstacle(solid.pose.x_m, solid.pose.y_m, solid.outline.radius_m, solid.height_m)
    return ConvexObstacle(solid.vertices, solid.height_m)


class Surroundings:
    """The obstacles around a robot, for sensors that measure robot by robot; `raycast.rays` has kernels for all."""

    __slots__ = ("_obstacles",)

    def __init__(self, obstacles: Iterable[Obstacle]) -> None:
        self._obstacles = tuple(obstacles)

    @property
    def is_empty(self) -> bool:
        """Whether there are no obstacles."""
        return not self._obstacles

    def near(self, x_m: float, y_m: float, reach_m: float) -> Surroundings:
        """The obstacles that may be within `reach_m` of a point in the world's frame; a superset."""
        return Surroundings([obstacle for obstacle in self._obstacles if obstacle.is_within(x_m, y_m, reach_m)])

    def fan(
        self, x_m: float, y_m: float, directions: Sequence[tuple[float, float]], range_m: float
    ) -> tuple[float, ...]:
        """The distances in m from a point to the nearest obstacle along each unit direction.

        Point and directions are in the world's frame. The distance is `inf` where no obstacle is within `range_m`.
        """
        found = []
        # A little more than the range, so that rounding does not hide an obstacle at exactly the range.
        limit = range_m * (1.0 + 1e-12)
        for dx, dy in directions:
            nearest = limit
            for obstacle in self._obstacles:
                nearest = obstacle.distance(x_m, y_m, dx, dy, nearest)
            found.append(nearest if nearest < limit else math.inf)
        return tuple(found)
