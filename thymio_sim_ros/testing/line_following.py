"""Check of line following: distance of the ground sensors from the center line, and driven length of the track."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.model.geometry import Point
from thymio_sim_ros.sim.playground.reader import Playground
from thymio_sim_ros.sim.shapes.track import Track
from thymio_sim_ros.testing.checks import Check
from thymio_sim_ros.testing.thymio import Thymio

__all__ = ["TrackLine", "followed_line"]

SENSOR_CENTER: Point = (robot_constants.GROUND_SENSORS[0][0], 0.0)
"""Center between the ground sensors in the frame of the robot, in m."""

_SENSOR_OFFSET_M = robot_constants.GROUND_SENSORS[0][1]
"""Distance of each ground sensor from that center."""

EVERY = 5
"""Ticks between two samples: 1 cm at full speed."""

_TIE_M = 0.01
_MAX_JUMP_M = 0.1
"""Where segments of a track cross, several may be nearest within `_TIE_M`. The segment that continues the driven
distance is chosen: a robot does not advance more than `_MAX_JUMP_M` between two samples."""


class TrackLine:
    """Center line of a track, as segments between points."""

    def __init__(self, points: Sequence[Point], *, closed: bool) -> None:
        self.closed = closed
        ring = [*points, points[0]] if closed else list(points)
        pieces = [(a, b) for a, b in itertools.pairwise(ring) if a != b]
        begins = itertools.accumulate((math.dist(a, b) for a, b in pieces), initial=0.0)
        self._pieces = [(a, b, begin) for (a, b), begin in zip(pieces, begins, strict=False)]
        self.length_m = math.fsum(math.dist(a, b) for a, b in pieces)

    @classmethod
    def of(cls, playground: Playground, name: str = "") -> tuple[TrackLine, Track]:
        """Return the only track of a playground, or the one of a name. Raises ValueError with the known names."""
        tracks = {shape.name: shape.shape for shape in playground.shapes if isinstance(shape.shape, Track)}
        if name not in tracks and (name or len(tracks) != 1):
            wanted = f"no track '{name}'" if name else f"{len(tracks)} tracks, name one of them"
            raise ValueError(f"playground {playground.name}: {wanted}; found {', '.join(tracks) or 'none'}")
        track = tracks[name or next(iter(tracks))]
        return cls([(x, y) for x, y, _ in track.stations()], closed=track.closed), track

    def distance(self, point: Point) -> float:
        """Distance in m from a point."""
        return min(math.dist(point, on) for on, _ in self._nearest(point))

    def locate(self, point: Point, last_m: float | None = None) -> tuple[float, float]:
        """Distance in m from a point, and how far along the line that is, near where it was last."""
        found = [(math.dist(point, on), along) for on, along in self._nearest(point)]
        nearest = min(found)
        if last_m is None or abs(self.offset(last_m, nearest[1])) < _MAX_JUMP_M:
            return nearest
        near = [along for distance, along in found if distance <= nearest[0] + _TIE_M]
        return nearest[0], min(near, key=lambda along: abs(self.offset(last_m, along)))

    def offset(self, from_m: float, to_m: float) -> float:
        """The way from a place on the line to another, the shorter one where it is closed."""
        return math.remainder(to_m - from_m, self.length_m) if self.closed else to_m - from_m

    def _nearest(self, point: Point) -> list[tuple[Point, float]]:
        """For each piece its point that is nearest, and how far along the line that is."""
        x, y = point
        found = []
        for (ax, ay), (bx, by), begin in self._pieces:
            dx, dy = bx - ax, by - ay
            length = math.hypot(dx, dy)
            along = min(length, max(0.0, ((x - ax) * dx + (y - ay) * dy) / length))
            found.append(((ax + dx * along / length, ay + dy * along / length), begin + along))
        return found


class _Progress:
    """A robot's way along a line, looked at once for each moment of its past."""

    def __init__(self, thymio: Thymio, line: TrackLine, since: float) -> None:
        self._thymio, self._line, self._since = thymio, line, since
        self._forget()

    def _forget(self) -> None:
        self._cleared = self._thymio.record.cleared
        self._next = 0
        self._last_m: float | None = None
        self.driven_m, self.farthest_m, self.farthest_s = 0.0, 0.0, 0.0

    def catch_up(self) -> None:
        """Look at what the robot did since the last time."""
        path = self._thymio.path
        if self._cleared != self._thymio.record.cleared:
            self._forget()
        for index in range(self._next, len(path), EVERY):
            self._next = index + EVERY
            moment = path[index]
            if moment.at_s < self._since:
                continue
            distance, along = self._line.locate(moment.pose.place(SENSOR_CENTER), self._last_m)
            if distance > self.farthest_m:
                self.farthest_m, self.farthest_s = distance, moment.at_s
            if self._last_m is not None:
                self.driven_m += self._line.offset(self._last_m, along)
            self._last_m = along


def followed_line(
    thymio: Thymio, *, within: float | None = None, laps: float = 1.0, track: str = "", since: float = 0.0
) -> Check:
    """The robot drove so many times along the track, in either direction, and a ground sensor was always above it.

    `within`: how far in m the middle between the ground sensors may be from the middle of the track, where that is not
    to follow from its width. `track`: its name, where the playground has several. ValueError: there is no such track.
    """
    line, shape = TrackLine.of(thymio.stage.world.playground, track)
    limit = shape.width_m / 2 + _SENSOR_OFFSET_M if within is None else within
    progress = _Progress(thymio, line, since)

    def judge() -> tuple[bool, str]:
        progress.catch_up()
        driven = abs(progress.driven_m) / line.length_m
        text = f"{thymio.name} drove {driven:.2f} of {laps:g} laps, at most {progress.farthest_m * 1000:.0f} mm"
        text += f" from the line (at {progress.farthest_s:.2f} s): expected at most {limit * 1000:.0f} mm"
        return driven >= laps and progress.farthest_m <= limit, text

    return Check(judge)
