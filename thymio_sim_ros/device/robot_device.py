"""Interface of a robot's Aseba side for its owner, be it a simulated device or a robot behind a network."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Protocol

from aseba_vm.protocol import Message
from thymio_sim_ros.device.due_time import DueTime
from thymio_sim_ros.device.network_events import EmittedEvent
from thymio_sim_ros.device.notices import Notices
from thymio_sim_ros.device.programs.breakpoints import Breakpoints
from thymio_sim_ros.device.programs.load import LoadMeter
from thymio_sim_ros.device.programs.program import ThymioProgram
from thymio_sim_ros.device.programs.status import DeviceStatus
from thymio_sim_ros.sim.commands import Command

__all__ = ["RobotDevice", "RobotHost", "RobotLocalEvents", "RobotNode", "RobotRunControl", "RobotVariables"]


class RobotVariables(Protocol):
    """Variables by name; the methods are those of `device.variables.DeviceVariables`."""

    def addresses(self) -> dict[str, tuple[int, int]]:
        """Address and size in words of every variable."""

    def words(self) -> list[int]:
        """Words of all variables in order of address."""

    def get(self, name: str) -> tuple[int, ...]:
        """Words of a variable."""

    def set(self, name: str, words: Sequence[int]) -> None:
        """Write a whole variable."""


class RobotRunControl(Protocol):
    """Run control; the methods are those of `device.run_control.RunControl`."""

    @property
    def breakpoints(self) -> Breakpoints:
        """The breakpoints at lines."""

    def resume(self) -> None:
        """Continue execution, or switch the robot on."""

    def pause(self) -> None:
        """Stop execution until `step` or `resume`."""

    def step(self) -> None:
        """Execute one instruction."""

    def step_line(self) -> None:
        """Execute up to the next line."""

    def stop(self) -> None:
        """Abort the handler and stop the wheels."""

    def reset(self) -> None:
        """Reset the robot, which waits before the start of the program."""

    def switch_off(self) -> None:
        """Switch the robot off."""


class RobotLocalEvents(Protocol):
    """Local events that are published."""

    @property
    def has_occurred(self) -> bool:
        """Whether `pop` would return events."""

    def watch(self, names: Collection[str]) -> None:
        """Replace the names of the events."""

    def pop(self) -> list[str]:
        """Return and clear the names of those that happened."""


class RobotDevice(Protocol):
    """The Aseba side of a robot; implemented by `AsebaDevice` and `RemoteDevice`."""

    @property
    def layout(self) -> str:
        """Name of the memory layout."""

    @property
    def node_id(self) -> int:
        """Number of the robot on its network."""

    @property
    def radio(self) -> tuple[int, int]:
        """Channel and network of its radio: robots receive events of their own network only."""

    @property
    def variables(self) -> RobotVariables:
        """The variables by name."""

    @property
    def run_control(self) -> RobotRunControl:
        """Run, pause, step, stop, reset, power."""

    @property
    def local_events(self) -> RobotLocalEvents:
        """The local events that a user watches."""

    @property
    def notices(self) -> Notices:
        """Messages for the user."""

    @property
    def load_meter(self) -> LoadMeter:
        """Counts of native calls and events."""

    @property
    def status(self) -> DeviceStatus:
        """State of the machine."""

    @property
    def is_busy(self) -> bool:
        """Whether `run` has work."""

    @property
    def due(self) -> DueTime:
        """The time from which `run` or `pop_commands` has anything to do."""

    @property
    def has_emitted(self) -> bool:
        """Whether `pop_events` would return events."""

    def feed(self, sensor: str, words: Sequence[int]) -> None:
        """Store the words of a reading."""

    def declares(self, event: str) -> bool:
        """Whether the program declares a global event of this name."""

    def receive_event(self, name: str, args: Sequence[int], *, source: int = 0) -> None:
        """Send a global event to the program."""

    def advance(self, now_ns: int) -> None:
        """Advance the time."""

    def run(self, budget: int) -> int:
        """Execute handlers; return the number of instructions."""

    def pop_commands(self) -> list[Command]:
        """Return and clear the commands for the actuators."""

    def pop_events(self) -> list[EmittedEvent]:
        """Return and clear the emitted events, in order."""


class RobotHost(Protocol):
    """The selection of a robot's program; implemented by `BehaviorHost` and `RemoteHost`."""

    @property
    def device(self) -> RobotDevice:
        """The robot."""

    @property
    def program(self) -> ThymioProgram:
        """The program that the robot runs."""

    @property
    def user_program(self) -> ThymioProgram | None:
        """The program of the user, which `restart` starts or which waits in the menu."""

    @property
    def behaviour(self) -> str:
        """Name of the built-in program that `restart` starts; "" if it starts that of the user."""

    @property
    def breakpoints(self) -> Sequence[int]:
        """The lines at which the user asked that the user program pauses, from 1."""

    @property
    def own_starts(self) -> int:
        """How often the robot has started a program by itself, as the menu does."""

    def load(self, program: ThymioProgram) -> None:
        """Load a user program and start it."""

    def set_breakpoints(self, lines: Sequence[int]) -> None:
        """Replace the breakpoints at lines of the user program, also for its next starts."""

    def remember(self, program: ThymioProgram) -> None:
        """Remember the text of a program whose bytecode may come from the network."""

    def start(self, name: str, user_program: ThymioProgram | None = None) -> None:
        """Switch the robot on with a built-in program."""

    def restart(self) -> None:
        """Repeat the last `load` or `start` with a new robot."""

    def resume(self) -> None:
        """Continue execution; switch a robot that is off on."""

    def pop_events(self) -> list[EmittedEvent]:
        """Return and clear the emitted events for other robots."""

    def pop_notices(self) -> list[str]:
        """Return and clear the notices for the user."""


class RobotNode(Protocol):
    """A robot as a node of an Aseba network, for clients; implemented by `NetworkNode` and `Gateway`."""

    def connect(self, client: int) -> None:
        """Add a client."""

    def disconnect(self, client: int) -> None:
        """Remove a client."""

    def handle(self, client: int, message: Message) -> list[Message]:
        """Execute a message of a client and return the replies for it."""

    def install_bytecode(self) -> None:
        """Make written bytecode the program."""

    def pop_messages(self) -> list[Message]:
        """Return and clear the messages for all clients."""
