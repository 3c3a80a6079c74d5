"""Replays run logs: gives the same inputs to the same worlds, and compares the result of each tick with the log."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from thymio_sim_ros.engine.run_log import LogEnded, LogEntry, RunLogError, TicksChecked, WorldStarted, digest, read
from thymio_sim_ros.sim.ground.sampling import Ground
from thymio_sim_ros.sim.input_recorder import Input, Posted, Removed, Reset, Spawned
from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.sim.world import World

__all__ = ["LoggedRun", "ReplayResult", "last_run", "replay"]


@dataclass(frozen=True, slots=True)
class ReplayResult:
    """Number of runs and of compared ticks, first difference, and whether the log is complete.

    A run is a world from its start or from a reset. `differs` has the numbers of run and tick, both from 1.
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
    """A world from its start or a reset: inputs by the tick after which they came, and digests of the ticks."""

    start: WorldStarted
    line: int
    inputs: dict[int, list[Input]] = field(default_factory=dict)
    last: int = 0
    """Tick of the latest input."""
    crcs: list[str] = field(default_factory=list)

    @property
    def ticks(self) -> int:
        """Length in ticks of 10 ms."""
        return len(self.crcs)

    def tick_at(self, seconds: float) -> int:
        """Return the tick at a time within the run; negative seconds count from its end."""
        tick = round(seconds * 1e9 / TICK_NS)
        return min(max(tick if seconds >= 0 else self.ticks + tick, 0), self.ticks)

    def new_world(self, ground: Ground | None = None) -> World:
        """Return the world at its start; `ground` saves the time to derive it. Raises ValueError for wrong options."""
        options = self.start.options
        return World(
            self.start.playground,
            seed=options.seed,
            noise=options.noise,
            proximity_model=options.proximity_model,
            motor_model=options.motor_model,
            periods_ns=None if options.periods_ns is None else dict(options.periods_ns),
            ground=ground,
        )

    def repeat_inputs(self, world: World) -> None:
        """Give a world what the log has for its present tick.

        Raises KeyError, TypeError or ValueError for inputs that this world cannot take.
        """
        for happened in self.inputs.get(world.now_ns // TICK_NS, ()):
            match happened:
                case Posted(name, command):
                    world.post(name, command)
                case Spawned(start):
                    world.spawn(start)
                case Removed(name):
                    world.remove(name)
                case Reset():
                    world.reset()


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
        ticks += len(run.crcs)
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
            run = LoggedRun(line, number)
        elif isinstance(line, LogEnded):
            has_ended = True
        elif run is None:
            raise RunLogError(path, number, "found what happened to no world, expected a world first")
        elif isinstance(line, TicksChecked):
            run.crcs.extend(line.crcs)
            if run.last > len(run.crcs):
                found = f"found the first {len(run.crcs)} ticks after an input at tick {run.last}"
                raise RunLogError(path, number, f"{found}, expected that many")
        elif isinstance(line[1], Reset):
            yield run
            run = LoggedRun(run.start, run.line)
        elif line[0] < max(len(run.crcs), run.last):
            raise RunLogError(path, number, f"found tick {line[0]}, expected {max(len(run.crcs), run.last)} or later")
        else:
            run.last = line[0]
            run.inputs.setdefault(line[0], []).append(line[1])
    if run is not None:
        yield run


def _first_difference(path: str, run: LoggedRun) -> int | None:
    """Replay a run; return the first tick, from 1, that differs from the log, or None."""
    try:
        world = run.new_world()
    except ValueError as error:
        raise RunLogError(path, run.line, str(error)) from error
    for tick, crc in enumerate(run.crcs):
        try:
            run.repeat_inputs(world)
        except (KeyError, TypeError, ValueError):
            return tick + 1
        result = world.step()
        if digest((result.now_ns, tuple(result.readings), result.contacts)) != crc:
            return tick + 1
    return None
