"""A stand-in for the engine in tests of commands."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterator, Sequence
from typing import Any

from thymio_sim_ros.batch_runs.failure import Failure

__all__ = ["Loop"]


class Loop:
    """Stands for the engine: a plain loop in this process. `calls` has the tasks of each call."""

    def __init__(self) -> None:
        self.calls: list[list[Any]] = []
        self.failing: Container[Any] = ()
        self.after_each: Callable[[], None] = lambda: None

    def run_all(self, function: Callable[[Any], Any], tasks: Sequence[Any], **_: object) -> Iterator[list[Any]]:
        self.calls.append(list(tasks))
        for index, task in reversed(list(enumerate(tasks))):  # any order
            yield []
            yield [(index, Failure("broken") if task in self.failing else function(task))]
            self.after_each()
