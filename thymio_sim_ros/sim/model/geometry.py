"""Plane geometry: poses, twists, and convex outlines as half planes that rays and overlap tests use.

Right-handed, x forward, y left, angles in radians counter-clockwise from x (REP 103); meters.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

__all__ = [
    "LEVEL",
    "Point",
    "Pose",
    "Tilt",
    "Twist",
    "convex_hulls_overlap",
    "disc_overlaps_hull",
    "is_convex",
    "wrap_angle",
]

Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Pose:
    """Position in meters and heading in radians."""

    x_m: float
    y_m: float
    yaw_rad: float

    def place(self, point: Point) -> Point:
        """Transform a point from the frame of this pose to the frame in which the pose is given."""
        cos, sin = math.cos(self.yaw_rad), math.sin(self.yaw_rad)
        return (self.x_m + cos * point[0] - sin * point[1], self.y_m + sin * point[0] + cos * point[1])

    def place_all(self, points: Sequence[Point]) -> tuple[Point, ...]:
        """Transform points as `place` does."""
        cos, sin = math.cos(self.yaw_rad), math.sin(self.yaw_rad)
        return tuple((self.x_m + cos * x - sin * y, self.y_m + sin * x + cos * y) for x, y in points)


@dataclass(frozen=True, slots=True)
class Twist:
    """Velocity of a body in its own frame: m/s forward and rad/s counter-clockwise."""

    linear_m_s: float
    angular_rad_s: float


@dataclass(frozen=True, slots=True)
class Tilt:
    """The tilt of a body: roll is positive with its left side up, pitch with its nose down (REP 103)."""

    roll_rad: float
    pitch_rad: float


LEVEL = Tilt(0.0, 0.0)


def wrap_angle(angle_rad: float) -> float:
    """The same direction in [-π, π]."""
    return math.remainder(angle_rad, math.tau)


def is_convex(vertices: Sequence[Point]) -> bool:
    """Whether the vertices go counter-clockwise around a convex area (straight corners are allowed)."""
    area = 0.0
    for index, (x, y) in enumerate(vertices):
        previous_x, previous_y = vertices[index - 1]
        next_x, next_y = vertices[(index + 1) % len(vertices)]
        if (x - previous_x) * (next_y - y) - (y - previous_y) * (next_x - x) < -1e-12:
            return False
        area += previous_x * y - x * previous_y
    return area > 0.0


def convex_hulls_overlap(one: Sequence[Point], other: Sequence[Point]) -> bool:
    """Whether two convex polygons overlap by more than an edge (separating axis theorem)."""
    return not (_has_separating_edge(one, other) or _has_separating_edge(other, one))


def disc_overlaps_hull(center: Point, radius_m: float, hull: Sequence[Point]) -> bool:
    """Whether a disc and a convex polygon overlap by more than an edge."""
    outside = False
    for (ax, ay), (bx, by) in _edges(hull):
        dx, dy = bx - ax, by - ay
        px, py = center[0] - ax, center[1] - ay
        if dx * py - dy * px < 0.0:
            outside = True
        along = min(1.0, max(0.0, (px * dx + py * dy) / (dx * dx + dy * dy)))
        if math.hypot(px - along * dx, py - along * dy) < radius_m:
            return True
    return not outside


def _edges(hull: Sequence[Point]) -> list[tuple[Point, Point]]:
    return [(hull[index - 1], hull[index]) for index in range(len(hull))]


def _has_separating_edge(hull: Sequence[Point], other: Sequence[Point]) -> bool:
    return any(
        all((bx - ax) * (y - ay) - (by - ay) * (x - ax) <= 1e-12 for x, y in other)
        for (ax, ay), (bx, by) in _edges(hull)
    )
