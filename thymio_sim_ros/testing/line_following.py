"""Check of line following: distance of the ground sensors from the center line, and driven length of the track."""

from __future__ import annotations

from thymio_sim_ros.sim.playground.track_line import EVERY, SENSOR_OFFSET_M, TrackLine, TrackProgress
from thymio_sim_ros.testing.checks import Check
from thymio_sim_ros.testing.thymio import Thymio

__all__ = ["followed_line"]


class _Past:
    """A robot's way along a line, computed once for each moment of its past."""

    def __init__(self, thymio: Thymio, line: TrackLine, since: float) -> None:
        self._thymio, self._line, self._since = thymio, line, since
        self._forget()

    def _forget(self) -> None:
        self._cleared = self._thymio.record.cleared
        self._next = 0
        self.progress = TrackProgress(self._line)

    def catch_up(self) -> TrackProgress:
        """The progress until now."""
        path = self._thymio.path
        if self._cleared != self._thymio.record.cleared:
            self._forget()
        for index in range(self._next, len(path), EVERY):
            self._next = index + EVERY
            moment = path[index]
            if moment.at_s >= self._since:
                self.progress.add(moment.at_s, moment.pose)
        return self.progress


def followed_line(
    thymio: Thymio, *, within: float | None = None, laps: float = 1.0, track: str = "", since: float = 0.0
) -> Check:
    """The robot drove so many times along the track, in either direction, and a ground sensor was always above it.

    `within`: how far in m the middle between the ground sensors may be from the middle of the track, where that is not
    to follow from its width. `track`: its name, where the playground has several. ValueError: there is no such track.
    """
    line, shape = TrackLine.of(thymio.stage.world.playground, track)
    limit = shape.width_m / 2 + SENSOR_OFFSET_M if within is None else within
    past = _Past(thymio, line, since)

    def judge() -> tuple[bool, str]:
        progress = past.catch_up()
        driven = progress.laps
        text = f"{thymio.name} drove {driven:.2f} of {laps:g} laps, at most {progress.farthest_m * 1000:.0f} mm"
        text += f" from the line (at {progress.farthest_s:.2f} s): expected at most {limit * 1000:.0f} mm"
        return driven >= laps and progress.farthest_m <= limit, text

    return Check(judge)
