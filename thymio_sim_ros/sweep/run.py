"""One run of a sweep as a pure function: the same sweep and number give the same rows on any machine."""

from __future__ import annotations

import time

from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.engine.faults import ProgramFaults
from thymio_sim_ros.sim.playground.reader import Playground
from thymio_sim_ros.sim.playground.track_line import TrackLine
from thymio_sim_ros.sweep.errors import SweepError
from thymio_sim_ros.sweep.grid import Sweep, Value
from thymio_sim_ros.sweep.measures import RobotRecord, measure_of
from thymio_sim_ros.sweep.parameters import start

__all__ = ["LimitError", "Row", "failed_row", "run_robots"]

Row = dict[str, Value | None]
"""A row of the table by name of the column (`table.columns`)."""

_CHECKED_TICKS = 100
"""Ticks between two checks of the limit."""


class LimitError(SweepError):
    """A run that takes more processor time than its sweep allows."""


def run_robots(sweep: Sweep, number: int) -> list[Row]:
    """Execute a run; return a row for each robot. Raises SweepError if it cannot be executed or exceeds its limit."""
    engine = start(sweep.run(number))
    line = _only_line(engine.world.playground)
    records = {name: RobotRecord(robot, engine.devices.get(name), line) for name, robot in engine.world.robots.items()}
    faults = ProgramFaults(engine, lambda _: None)
    _record_events(engine, records)
    begun_s = time.thread_time()
    for tick, result in enumerate(faults.checked(engine.steps(sweep.seconds, ()))):
        seconds = result.now_ns / 1e9
        for record in records.values():
            record.add_tick(seconds)
        _record_events(engine, records)
        if tick % _CHECKED_TICKS == 0 and time.thread_time() - begun_s > sweep.limit_s:
            raise LimitError(f"stopped at {sweep.limit_s:g} s of processor time, the limit of a run")
    head = _head(sweep, number)
    measures = {name: measure_of(name) for name in sweep.measures}
    return [
        {
            **head,
            "robot": name,
            **{column: measure.read(record) for column, measure in measures.items()},
            "fault": faults.first.get(name),
            "error": None,
        }
        for name, record in records.items()
    ]


def failed_row(sweep: Sweep, number: int, error: str) -> Row:
    """The row of a run without a result."""
    return {**_head(sweep, number), "robot": None, **dict.fromkeys(sweep.measures), "fault": None, "error": error}


def _head(sweep: Sweep, number: int) -> Row:
    found = sweep.run(number)
    return {
        "run": number,
        "program": found.program.name,
        "playground": found.playground.name,
        **dict(found.values),
        "seed": found.seed,
    }


def _only_line(playground: Playground) -> TrackLine | None:
    try:
        return TrackLine.of(playground)[0]
    except ValueError:  # no track, or several
        return None


def _record_events(engine: Engine, records: dict[str, RobotRecord]) -> None:
    for name, event in engine.emitted:
        records[name].add_event(event.name, engine.now_ns / 1e9)
