"""Measures of a run: one record per robot, filled tick by tick, and a table of measures that read it."""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Callable, Collection, Mapping
from typing import NamedTuple

from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.layout import target
from thymio_sim_ros.device.programs.program import ThymioProgram
from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.sim.playground.track_line import EVERY, TrackLine, TrackProgress
from thymio_sim_ros.sim.robot.robot import Robot
from thymio_sim_ros.sweep.errors import SweepError
from thymio_sim_ros.sweep.grid import Value

__all__ = ["MEASURES", "Measure", "RobotRecord", "check_measure", "measure_of"]

CELL_M = 0.05
"""Side of the squares in which the visited area is counted."""

_TICK_S = TICK_NS * 1e-9


class RobotRecord:
    """The motion and contacts of a robot in a run so far."""

    def __init__(self, robot: Robot, device: AsebaDevice | None, line: TrackLine | None) -> None:
        """Begin the record of a robot, its device if it has one, and the track that it may follow."""
        self.robot, self.device = robot, device
        self.seconds = 0.0
        self.distance_m = self.turned_rad = 0.0
        self.contacts = self.contact_ticks = 0
        self.event_times: dict[str, list[float]] = {}
        self.track = None if line is None else TrackProgress(line)
        self._ticks = 0
        self._touching: frozenset[str] = frozenset()
        self._last = robot.pose
        self._cells = {self._cell()}

    @property
    def area_m2(self) -> float:
        """Area of the visited squares."""
        return round(len(self._cells) * CELL_M**2, 4)

    def add_tick(self, seconds: float) -> None:
        """Record the state of the robot after a tick, at a simulated time in s."""
        self.seconds = seconds
        pose, last = self.robot.pose, self._last
        self.distance_m += math.hypot(pose.x_m - last.x_m, pose.y_m - last.y_m)
        self.turned_rad += abs(math.remainder(pose.yaw_rad - last.yaw_rad, math.tau))
        self._last = pose
        self._cells.add(self._cell())
        if self.robot.body.touching or self._touching:
            touching = frozenset(contact.other for contact in self.robot.body.touching.values())
            self.contacts += len(touching - self._touching)
            self.contact_ticks += bool(touching)
            self._touching = touching
        if self.track is not None and self._ticks % EVERY == 0:
            self.track.add(seconds, pose)
        self._ticks += 1

    def add_event(self, name: str, seconds: float) -> None:
        """Record an event that the program emitted at a simulated time in s."""
        self.event_times.setdefault(name, []).append(seconds)

    def _cell(self) -> tuple[int, int]:
        return math.floor(self._last.x_m / CELL_M), math.floor(self._last.y_m / CELL_M)


class Measure(NamedTuple):
    """The type of its values, what it is, and how it follows from a record; None: it does not apply."""

    type: type[Value]
    about: str
    read: Callable[[RobotRecord], Value | None]


MEASURES: Mapping[str, Measure] = {
    "seconds": Measure(float, "simulated time, s", lambda record: record.seconds),
    "x_m": Measure(float, "true position at the end, m", lambda record: record.robot.pose.x_m),
    "y_m": Measure(float, "true position at the end, m", lambda record: record.robot.pose.y_m),
    "yaw_rad": Measure(float, "true heading at the end, rad", lambda record: record.robot.pose.yaw_rad),
    "distance_m": Measure(float, "length of the path, m", lambda record: record.distance_m),
    "turned_rad": Measure(float, "sum of all turns, in either direction, rad", lambda record: record.turned_rad),
    "area_m2": Measure(float, "visited area, in squares of 5 cm, m²", lambda record: record.area_m2),
    "contacts": Measure(int, "number of contacts that began", lambda record: record.contacts),
    "contact_s": Measure(float, "time in contact, s", lambda record: round(record.contact_ticks * _TICK_S, 2)),
    "laps": Measure(
        float, "driven part of the only track", lambda record: None if record.track is None else record.track.laps
    ),
    "line_m": Measure(
        float,
        "largest distance of the ground sensors from the middle of the only track, m",
        lambda record: None if record.track is None else record.track.farthest_m,
    ),
    "events": Measure(
        int, "number of events that the program emitted", lambda record: sum(map(len, record.event_times.values()))
    ),
    "fallen": Measure(bool, "whether it lies beside the floor at the end", lambda record: record.robot.is_fallen),
}
"""The measures of a run, in the order of the table."""

_NAMED = re.compile(r"(?P<kind>event|first|variable)\.(?P<name>[^\[\]]+)(\[(?P<index>\d+)\])?")


def measure_of(name: str) -> Measure:
    """A measure by name: one of MEASURES, `event.NAME`, `first.NAME`, `variable.NAME` or `variable.NAME[i]`.

    Raises SweepError for another name.
    """
    if name in MEASURES:
        return MEASURES[name]
    found = _NAMED.fullmatch(name)
    if found is None or (found["index"] and found["kind"] != "variable"):
        raise SweepError(
            f"measure: found '{name}', expected one of {', '.join(MEASURES)}, event.NAME, first.NAME or variable.NAME"
        )
    of, index = found["name"], int(found["index"] or 0)
    if found["kind"] == "variable":
        return Measure(int, "word of a variable at the end", lambda record: _word(record, of, index))
    if found["kind"] == "event":
        return Measure(int, "number of times an event was emitted", lambda record: len(record.event_times.get(of, ())))
    return Measure(
        float, "time at which an event was first emitted, s", lambda record: record.event_times.get(of, [None])[0]
    )


def check_measure(name: str, programs: Collection[ThymioProgram]) -> None:
    """Check that a program has the event or variable of a measure. Raises SweepError that names what there is."""
    found = None if name in MEASURES else _NAMED.fullmatch(name)
    if found is None:
        return
    of, index = found["name"], int(found["index"] or 0)
    events = {event for program in programs for event, _ in program.events}
    sizes: dict[str, int] = {}
    for program in programs:
        of_robot = {variable.name: variable.size for variable in target(program.layout).variables}
        own = {variable: size for variable, (_, size) in program.program.addresses.items()}
        for variable, size in (of_robot | own).items():
            sizes[variable] = max(size, sizes.get(variable, 0))
    what = "variable" if found["kind"] == "variable" else "event"
    known = sorted(sizes if what == "variable" else events)
    if of not in known:
        near = difflib.get_close_matches(of, known, 1)
        raise SweepError(
            f"measure {name}: no program has the {what} '{of}', expected one of {', '.join(known) or 'none'}"
            + (f"; did you mean '{near[0]}'?" if near else "")
        )
    if found["kind"] == "variable" and index >= sizes[of]:
        raise SweepError(f"measure {name}: found index {index}, expected one below {sizes[of]}, the size of {of}")


def _word(record: RobotRecord, variable: str, index: int) -> int | None:
    variables = None if record.device is None else record.device.variables
    if variables is None or variable not in variables.addresses():
        return None
    words = variables.get(variable)
    return words[index] if index < len(words) else None
