"""The inputs of an engine: all that can change a run, besides what it was started with.

Each is applied between two ticks. The same start and the same inputs at the same ticks give the same run bit for bit.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol

from aseba_vm.protocol import Message
from thymio_sim_ros.device.options import DEFAULTS, DeviceOptions
from thymio_sim_ros.device.programs.program import ThymioProgram
from thymio_sim_ros.sim.commands import Command
from thymio_sim_ros.sim.playground.reader import Playground, RobotStart
from thymio_sim_ros.sim.world import WorldOptions

__all__ = [
    "CONTROLS",
    "BreakpointsSet",
    "ClientConnected",
    "ClientDisconnected",
    "Controlled",
    "DeviceStart",
    "DevicesAdded",
    "DrawingsErased",
    "EventSent",
    "GroundPainted",
    "Input",
    "Loaded",
    "MessagesReceived",
    "Posted",
    "ProgramInput",
    "Recorder",
    "Remembered",
    "Removed",
    "Reset",
    "RunStart",
    "Spawned",
    "VariableSet",
]

CONTROLS = ("run", "pause", "step", "step_line", "stop", "reset", "switch_off")
"""Words of `Controlled`, the methods of the run control of a robot; `run` also switches it on."""


@dataclass(frozen=True, slots=True)
class DeviceStart:
    """Start of the device of a robot: its number on the network, its program, and breakpoints at lines of the program.

    With a `behaviour`, such as "menu", the robot is switched on with that, and the program waits in the menu.
    """

    number: int
    program: ThymioProgram | None
    behaviour: str = ""
    breakpoints: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class RunStart:
    """Start of a run: its world, and the devices by the names of their robots."""

    playground: Playground
    world: WorldOptions
    devices: Mapping[str, DeviceStart] = field(default_factory=dict)
    options: DeviceOptions = DEFAULTS
    shares_numbers: bool = False
    """Whether other programs have given all robots one list of events, so that events without names reach others."""


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
class DrawingsErased:
    """Everything that pens drew was erased."""


@dataclass(frozen=True, slots=True)
class GroundPainted:
    """The first floor got another color: red, green, blue 0…1."""

    color: tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Reset:
    """World, noise and programs were reset; ticks are counted from 0 again."""


@dataclass(frozen=True, slots=True)
class DevicesAdded:
    """Robots got devices, which start together; a device that the robot had is replaced. See `RunStart`."""

    devices: Mapping[str, DeviceStart]
    options: DeviceOptions = DEFAULTS
    shares_numbers: bool = False


@dataclass(frozen=True, slots=True)
class Loaded:
    """A program was loaded into a robot and started; or a robot was switched on with a built-in `behaviour`.

    With a behaviour the program, if any, waits in the menu.
    """

    robot: str
    program: ThymioProgram | None
    behaviour: str = ""


@dataclass(frozen=True, slots=True)
class Remembered:
    """The text of a program whose bytecode may come from the network."""

    robot: str
    program: ThymioProgram


@dataclass(frozen=True, slots=True)
class Controlled:
    """The program of a robot was run, paused, stepped, stopped, reset or switched off: one of `CONTROLS`."""

    robot: str
    action: str


@dataclass(frozen=True, slots=True)
class BreakpointsSet:
    """All breakpoints of a robot were replaced by these lines of its program's file, from 1."""

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
    """A global event arrived at these robots, whose programs declare it.

    `source` is the number of the sender, 0 for a computer. Values that are not given are 0.
    """

    robots: tuple[str, ...]
    event: str
    args: tuple[int, ...]
    source: int = 0


@dataclass(frozen=True, slots=True)
class ClientConnected:
    """A client of the Aseba network of a robot has come."""

    robot: str
    client: int


@dataclass(frozen=True, slots=True)
class ClientDisconnected:
    """A client of the Aseba network of a robot has gone."""

    robot: str
    client: int


@dataclass(frozen=True, slots=True)
class MessagesReceived:
    """Messages of a client arrived at a robot."""

    robot: str
    client: int
    messages: tuple[Message, ...]


ProgramInput = (
    DevicesAdded
    | Loaded
    | Remembered
    | Controlled
    | BreakpointsSet
    | VariableSet
    | EventSent
    | ClientConnected
    | ClientDisconnected
    | MessagesReceived
)
Input = Posted | Spawned | Removed | DrawingsErased | GroundPainted | Reset | ProgramInput


class Recorder(Protocol):
    """Keeps the inputs of a run, and digests of its state."""

    def record(self, tick: int, happened: Input) -> None:
        """Keep an input that arrived after this many ticks."""

    def record_digest(self, tick: int, digest: str) -> None:
        """Keep the digest of the state after this many ticks."""
