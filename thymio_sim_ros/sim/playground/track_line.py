"""The center line of a track, and how far a robot drives along it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.model.geometry import Point, Pose
from thymio_sim_ros.sim.playground.reader import Playground
from thymio_sim_ros.sim.shapes.track import Track

__all__ = ["EVERY", "SENSOR_CENTER", "SENSOR_OFFSET_M", "TrackLine", "TrackProgress"]

SENSOR_CENTER: Point = (robot_constants.GROUND_SENSORS[0][0], 0.0)
"""Center between the ground sensors in the frame of the robot, in m."""

SENSOR_OFFSET_M = robot_constants.GROUND_SENSORS[0][1]
"""Distance of each ground sensor from that center."""

EVERY = 5
"""Ticks between two samples: 1 cm at full speed."""

_TIE_M = 0.01
_MAX_JUMP_M = 0.1
"""At a crossing of a track, several segments may be nearest within `_TIE_M`. The segment that continues the driven
distance is chosen: a robot does not advance more than `_MAX_JUMP_M` between two samples."""


class TrackLine:
    """Center line of a track, as segments between points."""

    def __init__(self, points: Sequence[Point], *, closed: bool) -> None:
        self.closed = closed
        ring = [*points, points[0]] if closed else list(points)
        pieces = [(a, b) for a, b in itertools.pairwise(ring) if a != b]
        begins = itertools.accumulate((math.dist(a, b) for a, b in pieces), initial=0.0)
        self._pieces = [
            (*a, b[0] - a[0], b[1] - a[1], math.hypot(b[0] - a[0], b[1] - a[1]), begin)
            for (a, b), begin in zip(pieces, begins, strict=False)
        ]
        """Begin, direction and length of each piece, and how far along the line it begins."""
        self.length_m = math.fsum(math.dist(a, b) for a, b in pieces)

    @classmethod
    def of(cls, playground: Playground, name: str = "") -> tuple[TrackLine, Track]:
        """The only track of a playground, or the one of a name. Raises ValueError with the known names."""
        tracks = {shape.name: shape.shape for shape in playground.shapes if isinstance(shape.shape, Track)}
        if name not in tracks and (name or len(tracks) != 1):
            wanted = f"no track '{name}'" if name else f"{len(tracks)} tracks, name one of them"
            raise ValueError(f"playground {playground.name}: {wanted}; found {', '.join(tracks) or 'none'}")
        track = tracks[name or next(iter(tracks))]
        return cls([(x, y) for x, y, _ in track.stations()], closed=track.closed), track

    def distance(self, point: Point) -> float:
        """Distance in m from a point."""
        return min(distance for distance, _ in self._nearest(point))

    def locate(self, point: Point, last_m: float | None = None) -> tuple[float, float]:
        """Distance in m from a point, and how far along the line that is, near where it was last."""
        found = self._nearest(point)
        nearest = min(found)
        if last_m is None or abs(self.offset(last_m, nearest[1])) < _MAX_JUMP_M:
            return nearest
        near = [along for distance, along in found if distance <= nearest[0] + _TIE_M]
        return nearest[0], min(near, key=lambda along: abs(self.offset(last_m, along)))

    def offset(self, from_m: float, to_m: float) -> float:
        """The way from a place on the line to another, the shorter one where it is closed."""
        return math.remainder(to_m - from_m, self.length_m) if self.closed else to_m - from_m

    def _nearest(self, point: Point) -> list[tuple[float, float]]:
        """For each piece the distance of its point that is nearest, and how far along the line that is."""
        x, y = point
        found = []
        for ax, ay, dx, dy, length, begin in self._pieces:
            along = ((x - ax) * dx + (y - ay) * dy) / length
            along = 0.0 if along < 0.0 else min(along, length)
            on = ax + dx * along / length, ay + dy * along / length
            found.append((math.dist(point, on), begin + along))
        return found


class TrackProgress:
    """The distance of a robot along a line, and its maximum distance from the line."""

    def __init__(self, line: TrackLine) -> None:
        self._line = line
        self._last_m: float | None = None
        self.driven_m = 0.0
        """Way along the line in m, negative against its direction."""
        self.farthest_m, self.farthest_s = 0.0, 0.0
        """Largest distance between the ground sensors and the line in m, and its time in s."""

    @property
    def laps(self) -> float:
        """Driven part of the length of the line, in either direction."""
        return abs(self.driven_m) / self._line.length_m

    def add(self, at_s: float, pose: Pose) -> None:
        """Add where the robot was at a time in s; every `EVERY` ticks is often enough."""
        distance, along = self._line.locate(pose.place(SENSOR_CENTER), self._last_m)
        if distance > self.farthest_m:
            self.farthest_m, self.farthest_s = distance, at_s
        if self._last_m is not None:
            self.driven_m += self._line.offset(self._last_m, along)
        self._last_m = along
