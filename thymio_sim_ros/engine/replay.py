"""Replays run logs: gives the same inputs to the same engines, and compares their states with the log."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from thymio_sim_ros.engine.engine import DIGEST_TICKS, Engine
from thymio_sim_ros.engine.inputs import Input, RunStart
from thymio_sim_ros.engine.run_log import (
    LogEnded,
    LogEntry,
    RunLogError,
    StateSeen,
    TicksChecked,
    WorldReset,
    WorldStarted,
    digest,
    read,
)
from thymio_sim_ros.sim.ground.sampling import Ground
from thymio_sim_ros.sim.model.clock import TICK_NS

__all__ = ["LoggedRun", "ReplayResult", "last_run", "replay"]


@dataclass(frozen=True, slots=True)
class ReplayResult:
    """Number of runs and of compared ticks, first difference, and whether the log is complete.

    A run is an engine from its start or from a reset. `differs` has the numbers of run and tick, both from 1: the first
    of the compared ticks, which are one in each second, or all in logs of version 1.
    """

    runs: int
    ticks: int
    differs: tuple[int, int] | None
    is_complete: bool

    @property
    def seconds(self) -> float:
        """Compared simulated time in s."""
        return self.ticks * TICK_NS * 1e-9


@dataclass(slots=True)
class LoggedRun:
    """A run from its start or a reset."""

    name: str
    """Name of the playground."""
    start: RunStart
    line: int
    entries: dict[int, list[Input | StateSeen]] = field(default_factory=dict)
    """Inputs and digests of the state, in order, by the tick after which they came."""
    last: int = 0
    """Tick of the latest input."""
    results: list[str] = field(default_factory=list)
    """Digests of the results of all ticks, in a log of version 1."""
    ticks: int = 0
    """Length in ticks of 10 ms."""

    def tick_at(self, seconds: float) -> int:
        """Return the tick at a time within the run; negative seconds count from its end."""
        tick = round(seconds * 1e9 / TICK_NS)
        return min(max(tick if seconds >= 0 else self.ticks + tick, 0), self.ticks)

    def new_engine(self, ground: Ground | None = None) -> Engine:
        """Return the engine at its start; `ground` saves the time to derive it. Raises ValueError for wrong options."""
        return Engine.of(self.start, ground)

    def repeat_inputs(self, engine: Engine) -> None:
        """Give an engine what the log has for its present tick.

        Raises KeyError, TypeError or ValueError for inputs that it cannot take.
        """
        for entry in self.entries.get(engine.tick, ()):
            if not isinstance(entry, StateSeen):
                engine.apply(entry)


def last_run(path: Path) -> LoggedRun:
    """Return the last run of a log that is not empty. Raises OSError or RunLogError if there is none."""
    runs = [run for run in _runs(str(path), list(read(path))) if run.ticks]
    if not runs:
        raise RunLogError(str(path), 1, "found no tick, expected at least one")
    return runs[-1]


def replay(path: Path) -> ReplayResult:
    """Replay a log up to the first difference. Raises OSError or RunLogError if it cannot be read."""
    lines = list(read(path))
    is_complete = bool(lines) and isinstance(lines[-1][1], LogEnded)
    ticks = number = 0
    for number, run in enumerate(_runs(str(path), lines), start=1):
        differs = _first_difference(str(path), run)
        if differs is not None:
            return ReplayResult(number, ticks + differs, (number, differs), is_complete)
        ticks += run.ticks
    return ReplayResult(number, ticks, None, is_complete)


def _runs(path: str, lines: list[tuple[int, LogEntry]]) -> Iterator[LoggedRun]:
    run: LoggedRun | None = None
    has_ended = False
    for number, line in lines:
        if has_ended:
            raise RunLogError(path, number, "found a line after the end, expected nothing")
        if isinstance(line, WorldStarted):
            if run is not None:
                yield run
            run = LoggedRun(line.name, line.start, number)
        elif isinstance(line, LogEnded):
            has_ended = True
        elif run is None:
            raise RunLogError(path, number, "found what happened to no world, expected a world first")
        elif isinstance(line, TicksChecked | StateSeen):
            _add_states(path, number, run, line)
        elif isinstance(line, WorldReset):
            yield run
            start, added = run.start, line.added
            if added is not None:
                start = RunStart(start.playground, start.world, added.devices, added.options, added.shares_numbers)
            run = LoggedRun(run.name, start, run.line)
        elif line[0] < max(run.ticks, run.last):
            raise RunLogError(path, number, f"found tick {line[0]}, expected {max(run.ticks, run.last)} or later")
        else:
            run.last = line[0]
            run.entries.setdefault(run.last, []).append(line[1])
    if run is not None:
        yield run


def _add_states(path: str, number: int, run: LoggedRun, line: TicksChecked | StateSeen) -> None:
    if isinstance(line, StateSeen):
        if line.tick < max(run.ticks, run.last):
            raise RunLogError(path, number, f"found tick {line.tick}, expected {max(run.ticks, run.last)} or later")
        if line.tick > run.ticks + DIGEST_TICKS:
            raise RunLogError(path, number, f"found tick {line.tick}, expected at most {run.ticks + DIGEST_TICKS}")
        run.entries.setdefault(line.tick, []).append(line)
        run.ticks = line.tick
        return
    run.results.extend(line.crcs)
    run.ticks += len(line.crcs)
    if run.last > run.ticks:
        found = f"found the first {run.ticks} ticks after an input at tick {run.last}"
        raise RunLogError(path, number, f"{found}, expected that many")


def _first_difference(path: str, run: LoggedRun) -> int | None:
    """Return the number of the first compared tick whose state or result is not that of the log, from 1."""
    try:
        engine = run.new_engine()
    except ValueError as error:
        raise RunLogError(path, run.line, str(error)) from error
    for tick in range(run.ticks + 1):
        if not _repeats(run, engine):
            return max(tick, 1)
        if tick == run.ticks:
            break
        result = engine.step(None if run.results else ())
        if run.results and run.results[tick] != digest((result.now_ns, tuple(result.readings), result.contacts)):
            return tick + 1
    return None


def _repeats(run: LoggedRun, engine: Engine) -> bool:
    """Give an engine the inputs of its present tick; return whether it takes them and has the states of the log."""
    for entry in run.entries.get(engine.tick, ()):
        if isinstance(entry, StateSeen):
            if engine.digest() != entry.digest:
                return False
            continue
        try:
            engine.apply(entry)
        except (KeyError, TypeError, ValueError):
            return False  # the inputs of a log are possible in its own world
    return True
