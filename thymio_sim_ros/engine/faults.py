"""Faults and notices of programs in a headless run; each is reported once, as soon as it occurs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from thymio_sim_ros.device.programs.status import FAULT
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.sim.world import StepResult

__all__ = ["ProgramFaults"]


class ProgramFaults:
    """Checks the robots of an engine after each step and reports faults and notices as lines of text.

    `first` holds the first fault of each robot whose program failed.
    """

    def __init__(self, engine: Engine, report: Callable[[str], None]) -> None:
        self.first: dict[str, str] = {}
        self._engine, self._report = engine, report
        self._reported: set[tuple[str, str]] = set()

    def checked(self, steps: Iterable[StepResult]) -> Iterator[StepResult]:
        """Yield these steps; check before the first one, for faults of initializations, and after each."""
        self._check()
        for step in steps:
            self._check()
            yield step

    def _check(self) -> None:
        for robot, host in self._engine.hosts.items():
            for notice in host.pop_notices():
                self._report_once(robot, notice)
            status = host.device.status
            if status.state == FAULT:
                place = "" if status.line is None else f", line {status.line}"
                fault = f"{host.program.name}: fault in {status.event}{place}: {status.fault}"
                self.first.setdefault(robot, fault)
                self._report_once(robot, fault)

    def _report_once(self, robot: str, text: str) -> None:
        if (robot, text) not in self._reported:
            self._reported.add((robot, text))
            self._report(f"{robot}, at {self._engine.now_ns / 1e9:.2f} s: {text}")
