"""A painted track: straight pieces between points, joined by arcs where a corner radius is given.

It is paint, neither an obstacle nor ground. Without a radius every piece is a rectangle of its own and
corners stay open on their outer side, as in the thesis (docs/spec/playground-formats.md section 2.2).
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

from thymio_sim_ros.sim.model.fields import Extent, FieldError, Points, Radius, Shade, as_color
from thymio_sim_ros.sim.model.geometry import Point
from thymio_sim_ros.sim.model.primitives import Paint, Primitive
from thymio_sim_ros.sim.shapes import ShapeKind

_ARC_STEP_RAD = math.radians(5)
_SAME_PLACE_M = 1e-9

_Station = tuple[float, float, float]
"""A place on the middle line: x, y, direction."""


@dataclass(frozen=True, slots=True)
class Track:
    """A strip of a width along points; closed: from the last point back to the first."""

    points_m: Points
    width_m: Extent
    color: Shade
    closed: bool = False
    corner_radius_m: Radius = 0.0

    def primitives(self, name: str) -> tuple[Primitive, ...]:
        """Quadrangles of paint along the middle line; an arc shares its edges with its neighbors."""
        half, color = self.width_m / 2, as_color(self.color)
        patches = []
        for (ax, ay, a), (bx, by, b) in itertools.pairwise(self.stations()):
            if math.hypot(bx - ax, by - ay) < _SAME_PLACE_M:
                continue
            ux, uy, vx, vy = -math.sin(a) * half, math.cos(a) * half, -math.sin(b) * half, math.cos(b) * half
            corners = ((ax - ux, ay - uy), (bx - vx, by - vy), (bx + vx, by + vy), (ax + ux, ay + uy))
            patches.append(Paint(name, corners, color))
        return tuple(patches)

    def stations(self) -> tuple[_Station, ...]:
        """The middle line: x, y in m and direction in rad, two stations for each straight piece and arc step.

        FieldError when all points are one, when arcs are tighter than half the width, or when the arcs at both
        ends of a piece need more than its length.
        """
        if 0.0 < self.corner_radius_m < self.width_m / 2:
            expected = f"0 or at least half of the width ({self.width_m / 2:g})"
            raise FieldError("corner_radius_m", f"{self.corner_radius_m:g}", expected, "radius")
        points = [point for index, point in enumerate(self.points_m) if index == 0 or point != self.points_m[index - 1]]
        if self.closed and len(points) > 1 and points[0] == points[-1]:
            points.pop()
        if len(points) < 2:
            raise FieldError("points_m", "a single place", "two different points", "places")
        ring = [*points, points[0]] if self.closed else points
        directions = [math.atan2(by - ay, bx - ax) for (ax, ay), (bx, by) in itertools.pairwise(ring)]
        stations: list[_Station] = []
        for index, direction in enumerate(directions):
            begin, end = ring[index], ring[index + 1]
            before = directions[index - 1] if index or self.closed else direction
            is_last = index + 1 == len(directions) and not self.closed
            after = direction if is_last else directions[(index + 1) % len(directions)]
            cut_begin, cut_end = self._cut(before, direction), self._cut(direction, after)
            if cut_begin + cut_end > math.dist(begin, end) + _SAME_PLACE_M:
                expected = f"room for the arcs on the piece from {begin} to {end}"
                raise FieldError("corner_radius_m", f"{self.corner_radius_m:g}", expected, "corners")
            cos, sin = math.cos(direction), math.sin(direction)
            stations.append((begin[0] + cut_begin * cos, begin[1] + cut_begin * sin, direction))
            stations.append((end[0] - cut_end * cos, end[1] - cut_end * sin, direction))
            stations.extend(self._arc(end, direction, after))
        return tuple(stations)

    def _cut(self, direction: float, after: float) -> float:
        """The length at the end of a straight piece that the arc of the corner replaces."""
        turn = abs(math.remainder(after - direction, math.tau))
        return self.corner_radius_m * math.tan(turn / 2) if turn < math.pi - 1e-6 else 0.0

    def _arc(self, corner: Point, direction: float, after: float) -> list[_Station]:
        """Stations on the arc of a corner, both of its ends included; none without a radius or a turn."""
        turn = math.remainder(after - direction, math.tau)
        cut = self._cut(direction, after)
        if cut == 0.0:
            return []
        radius = math.copysign(self.corner_radius_m, turn)
        start_x, start_y = corner[0] - cut * math.cos(direction), corner[1] - cut * math.sin(direction)
        center_x, center_y = start_x - radius * math.sin(direction), start_y + radius * math.cos(direction)
        steps = max(1, math.ceil(abs(turn) / _ARC_STEP_RAD))
        angles = [direction + turn * step / steps for step in range(steps + 1)]
        return [(center_x + radius * math.sin(a), center_y - radius * math.cos(a), a) for a in angles]


SHAPE = ShapeKind("track", Track, sample={"width_m": 0.03, "color": "#1a1a1a"})
