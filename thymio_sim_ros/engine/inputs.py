"""The inputs of an engine: all that can change a run, besides what it was started with.

Each is applied between two ticks. The same start and the same inputs at the same ticks give the same run bit for bit.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol

from thymio_sim_ros.device.options import DEFAULTS, DeviceOptions
from thymio_sim_ros.device.programs.program import ThymioProgram
from thymio_sim_ros.sim.commands import Command
from thymio_sim_ros.sim.playground.reader import Playground, RobotStart
from thymio_sim_ros.sim.world import WorldOptions

__all__ = [
    "CONTROLS",
    "BreakpointsSet",
    "Controlled",
    "DeviceStart",
    "EventSent",
    "Input",
    "Loaded",
    "Posted",
    "Recorder",
    "Removed",
    "Reset",
    "RunStart",
    "Spawned",
    "VariableSet",
]

CONTROLS = ("run", "pause", "step", "step_line", "stop", "reset", "switch_off")
"""What `Controlled` can do to a robot: the methods of its run control; `run` also switches it on."""


@dataclass(frozen=True, slots=True)
class DeviceStart:
    """What the device of a robot starts with: its number on the network, and its program.

    With a `behaviour`, such as "menu", the robot is switched on with that, and the program waits in the menu.
    """

    number: int
    program: ThymioProgram | None
    behaviour: str = ""


@dataclass(frozen=True, slots=True)
class RunStart:
    """What a run starts with: its world, and the devices by the names of their robots."""

    playground: Playground
    world: WorldOptions
    devices: Mapping[str, DeviceStart] = field(default_factory=dict)
    options: DeviceOptions = DEFAULTS


@dataclass(frozen=True, slots=True)
class Posted:
    """A command was posted to a robot or an object; it takes effect in the next tick."""

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
    """World, noise and programs were reset; ticks are counted from 0 again."""


@dataclass(frozen=True, slots=True)
class Loaded:
    """A program was loaded into a robot and started."""

    robot: str
    program: ThymioProgram


@dataclass(frozen=True, slots=True)
class Controlled:
    """The program of a robot was run, paused, stepped, stopped, reset or switched off: one of `CONTROLS`."""

    robot: str
    action: str


@dataclass(frozen=True, slots=True)
class BreakpointsSet:
    """All breakpoints of a robot were replaced by these lines of its file, from 1."""

    robot: str
    lines: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class VariableSet:
    """A whole variable of a program was written, in int16 words."""

    robot: str
    variable: str
    words: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class EventSent:
    """A global event arrived at these robots, whose programs declare it; they handle it in the next tick.

    `source` is the number of the sender, 0 for a computer.
    """

    robots: tuple[str, ...]
    event: str
    args: tuple[int, ...]
    source: int = 0


Input = Posted | Spawned | Removed | Reset | Loaded | Controlled | BreakpointsSet | VariableSet | EventSent


class Recorder(Protocol):
    """Keeps the inputs of a run, and digests of its state."""

    def record(self, tick: int, happened: Input) -> None:
        """Keep an input that arrived after this many ticks."""

    def record_digest(self, tick: int, digest: str) -> None:
        """Keep the digest of the state after this many ticks."""
