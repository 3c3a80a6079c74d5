"""Robots and programs in lock-step in a simulated world, without ROS: faster than real time and repeatable."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from thymio_sim_ros.device.programs.program import ThymioProgram, load_program
from thymio_sim_ros.device.robot_device import RobotDevice
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.engine.run_log import RunLog
from thymio_sim_ros.files.loading import robot_ids
from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.sim.playground.reader import Playground
from thymio_sim_ros.sim.world import World
from thymio_sim_ros.testing.awaited import Awaited
from thymio_sim_ros.testing.failure_messages import describe_condition
from thymio_sim_ros.testing.record import SECOND_NS
from thymio_sim_ros.testing.report import robot_lines
from thymio_sim_ros.testing.sources import playground_of, programs_of
from thymio_sim_ros.testing.thymio import RobotMachine, Thymio

__all__ = ["Classroom"]


@dataclass(frozen=True, slots=True)
class _ClassroomMachine:
    device: RobotDevice
    program: ThymioProgram


class Classroom:
    """A world and its robots. Invariant: time passes only in `run` and `until`, in ticks of 10 ms."""

    def __init__(
        self,
        playground: str | Path | Playground = "base",
        programs: str | Path | ThymioProgram | Mapping[str, str | Path | ThymioProgram] = "none",
        *,
        seed: int = 0,
        noise: bool = True,
        folder: Path | None = None,
        run_log: Path | None = None,
    ) -> None:
        """A playground by name, path or text; one file of programs for all robots, or one by robot's name.

        Relative paths start in `folder`. `run_log` is a file for the run log, which `close` completes. Raises
        PlaygroundError or ProgramError for invalid content, ResourceError for a missing file, KeyError for an unknown
        robot.
        """
        self._folder = folder
        loaded = playground_of(playground, folder)
        names = [robot.name for robot in loaded.robots]
        self._ids = robot_ids(names)
        own = dict.fromkeys(names, load_program("", "none"))
        if isinstance(programs, Mapping):
            for name, program in programs.items():
                _check_robot(name, names)
                own |= programs_of(program, {name: self._ids[name]}, folder)
        else:
            own = programs_of(programs, self._ids, folder)
        self._log = None if run_log is None else RunLog(run_log.open("w", encoding="utf-8", newline="\n"))
        self.engine = Engine(loaded, own, seed=seed, noise=noise)
        if self._log is not None:
            self._log.begin(loaded.name, self.engine)
        self.robots: Mapping[str, Thymio] = {name: Thymio(name, self) for name in names}
        self._record_events()

    def __getitem__(self, robot: str) -> Thymio:
        """A robot by name. Raises KeyError with the known names."""
        _check_robot(robot, list(self.robots))
        return self.robots[robot]

    def __iter__(self) -> Iterator[Thymio]:
        """The robots, in the order of the playground."""
        return iter(self.robots.values())

    def __len__(self) -> int:
        return len(self.robots)

    @property
    def world(self) -> World:
        """The simulated world."""
        return self.engine.world

    @property
    def now(self) -> float:
        """Simulated time in s."""
        return self.engine.now_ns / SECOND_NS

    def run(self, seconds: float) -> None:
        """Advance simulated time by this many seconds."""
        for _ in range(round(seconds * SECOND_NS / TICK_NS)):
            self.tick()

    def tick(self) -> None:
        """Advance simulated time by one tick of 10 ms."""
        self.engine.step(())
        self._record_events()
        for name, thymio in self.robots.items():
            robot = self.world.robots.get(name)
            if robot is not None:
                thymio.record.add_tick(robot, self.engine.now_ns)

    def until(self, condition: Callable[[], Any], seconds: float = 60.0, *, what: str = "") -> Any:
        """Advance time until the condition is true, at most this many simulated seconds; return its value.

        Otherwise the test fails with a report of the robots.
        """
        __tracebackhide__ = True
        end_ns = self.engine.now_ns + round(seconds * SECOND_NS)
        awaited = Awaited(condition)
        while not (value := awaited()):
            if self.engine.now_ns >= end_ns:
                head = f"not within {seconds:g} simulated s: {what or describe_condition(condition)}{awaited.missing()}"
                pytest.fail("\n".join([head, *robot_lines(self)]))
            self.tick()
        return value

    def reset(self) -> None:
        """Reset world, noise, programs and records to the start."""
        self.engine.reset()
        for thymio in self:
            thymio.record.clear()
        self._record_events()

    def close(self) -> None:
        """Complete the run log, if there is one; no time passes afterwards."""
        if self._log is not None:
            self._log.close()

    def machine(self, robot: str) -> RobotMachine:
        """The machine of a robot."""
        host = self.engine.hosts[robot]
        return _ClassroomMachine(host.device, host.program)

    def load(self, robot: str, program: str | Path | ThymioProgram) -> None:
        """Load a program, which starts at once."""
        self.engine.load(robot, programs_of(program, {robot: self._ids[robot]}, self._folder)[robot])
        self._record_events()

    def set_variable(self, robot: str, variable: str, words: Sequence[int]) -> None:
        """Write a whole variable of a program. Raises KeyError for an unknown name, ValueError for wrong words."""
        self.engine.set_variable(robot, variable, words)

    def emit(self, event: str, args: Sequence[int]) -> None:
        """Send an event to all robots that declare it, in the next tick. Raises LookupError if there is none."""
        try:
            self.engine.send_event(event, args)
        except KeyError as error:
            known = sorted({name for host in self.engine.hosts.values() for name, _ in host.program.events})
            text = f"no program declares the event '{event}', only {', '.join(known) or 'none'}"
            raise LookupError(text) from error

    def _record_events(self) -> None:
        for name, event in self.engine.emitted:
            self.robots[name].record.add_event(event.name, event.args, self.engine.now_ns)


def _check_robot(name: str, names: Sequence[str]) -> None:
    if name not in names:
        near = difflib.get_close_matches(name, names, 1)
        hint = f"; did you mean '{near[0]}'?" if near else ""
        raise KeyError(f"no robot '{name}', only {', '.join(names) or 'none'}{hint}")
