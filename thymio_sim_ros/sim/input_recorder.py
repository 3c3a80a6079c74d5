"""What happens to a world, told as it happens: enough to let the same happen again.

A world tells its journal every input with the number of ticks that had passed, and the result of every step.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from thymio_sim_ros.sim.commands import Command
from thymio_sim_ros.sim.playground.reader import RobotStart

__all__ = ["Input", "InputRecorder", "Posted", "Removed", "Reset", "Spawned", "WorldOptions"]


@dataclass(frozen=True, slots=True)
class WorldOptions:
    """Everything but the playground that a world is made with; `periods_ns` as pairs, None for the robot's own."""

    seed: int
    noise: bool
    proximity_model: str
    motor_model: str
    periods_ns: tuple[tuple[str, int], ...] | None = None


@dataclass(frozen=True, slots=True)
class Posted:
    """A command for a robot or thing."""

    name: str
    command: Command


@dataclass(frozen=True, slots=True)
class Spawned:
    """A robot was added."""

    start: RobotStart


@dataclass(frozen=True, slots=True)
class Removed:
    """A robot was taken away."""

    name: str


@dataclass(frozen=True, slots=True)
class Reset:
    """Everything is as at the start; ticks count from 0 again."""


Input = Posted | Spawned | Removed | Reset


class InputRecorder(Protocol):
    """Who writes down what happens to a world."""

    def record(self, tick: int, event: Input) -> None:
        """Something came in after so many ticks."""
        ...

    def record_step(self, result: object) -> None:
        """A step gave this; its `repr` tells it bit for bit."""
        ...
