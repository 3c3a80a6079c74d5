"""What programs of a batch run have to say: faults and notices, each told once, as soon as it is there."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from thymio_sim_ros.device.programs.status import FAULT
from thymio_sim_ros.runner import Runner
from thymio_sim_ros.sim.world import StepResult

__all__ = ["Faults"]


class Faults:
    """Looks at the robots of a runner after each step, and tells lines of text.

    `first` holds the first fault of each robot whose program failed.
    """

    def __init__(self, runner: Runner, tell: Callable[[str], None]) -> None:
        self.first: dict[str, str] = {}
        self._runner, self._tell = runner, tell
        self._told: set[tuple[str, str]] = set()

    def watched(self, steps: Iterable[StepResult]) -> Iterator[StepResult]:
        """These steps, with a look before the first, for initialisations, and after each."""
        self._look()
        for step in steps:
            self._look()
            yield step

    def _look(self) -> None:
        for robot, host in self._runner.hosts.items():
            for notice in host.take_notices():
                self._say(robot, notice)
            status = host.device.status
            if status.state == FAULT:
                place = "" if status.line is None else f", line {status.line}"
                fault = f"{host.program.name}: fault in {status.event}{place}: {status.fault}"
                self.first.setdefault(robot, fault)
                self._say(robot, fault)

    def _say(self, robot: str, text: str) -> None:
        if (robot, text) not in self._told:
            self._told.add((robot, text))
            self._tell(f"{robot}, at {self._runner.now_ns / 1e9:.2f} s: {text}")
