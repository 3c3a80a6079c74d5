"""The inputs of a world, recorded so that a run can be repeated.

A world passes every input to its recorder, with the number of ticks before it, and the result of every step.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from thymio_sim_ros.sim.commands import Command
from thymio_sim_ros.sim.playground.reader import RobotStart

__all__ = ["Input", "InputRecorder", "Posted", "Removed", "Reset", "Spawned", "WorldOptions"]


@dataclass(frozen=True, slots=True)
class WorldOptions:
    """The options of a world besides its playground; `periods_ns` as pairs, None for the periods of the sensors."""

    seed: int
    noise: bool
    proximity_model: str
    motor_model: str
    periods_ns: tuple[tuple[str, int], ...] | None = None


@dataclass(frozen=True, slots=True)
class Posted:
    """A command was posted to a robot or an object."""

    name: str
    command: Command


@dataclass(frozen=True, slots=True)
class Spawned:
    """A robot was added."""

    start: RobotStart


@dataclass(frozen=True, slots=True)
class Removed:
    """A robot was removed."""

    name: str


@dataclass(frozen=True, slots=True)
class Reset:
    """The world was reset; ticks are counted from 0 again."""


Input = Posted | Spawned | Removed | Reset


class InputRecorder(Protocol):
    """Records the inputs and results of a world."""

    def record(self, tick: int, event: Input) -> None:
        """Record an input that arrived after this many ticks."""
        ...

    def record_step(self, result: object) -> None:
        """Record the result of a step; its `repr` is exact to the bit."""
        ...
