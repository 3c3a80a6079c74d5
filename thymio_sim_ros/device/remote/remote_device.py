"""A robot behind an Aseba network as a `RobotDevice`: its program runs there, and its variables are polled."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence

from thymio_sim_ros.device.behavior_host import built_in, is_internal
from thymio_sim_ros.device.due_time import DueTime
from thymio_sim_ros.device.layout import target
from thymio_sim_ros.device.network_events import EmittedEvent
from thymio_sim_ros.device.notices import Notices
from thymio_sim_ros.device.programs.foreign import foreign_program
from thymio_sim_ros.device.programs.load import LoadMeter
from thymio_sim_ros.device.programs.program import ThymioProgram, load_program
from thymio_sim_ros.device.programs.status import DeviceStatus
from thymio_sim_ros.device.remote.ros_handlers import RemoteProgram, extended
from thymio_sim_ros.device.remote.run_control import RemoteRunControl
from thymio_sim_ros.device.remote.session import Session
from thymio_sim_ros.device.remote.variables import RemoteVariables
from thymio_sim_ros.sim.commands import Command

__all__ = ["RemoteDevice", "RemoteHost"]

MAX_EVENTS = 256
"""Events of the robot that wait for the owner; further ones are lost, with a notice."""


class RemoteLocalEvents:
    """A remote robot raises its local events itself, and only its program receives them."""

    has_occurred = False
    """Whether `pop` would return events."""

    def __init__(self, notices: Notices) -> None:
        self._notices = notices

    def watch(self, names: Collection[str]) -> None:
        """Report that local events are not published."""
        if names:
            self._notices.add(f"local events of a real robot are not published: {', '.join(sorted(names))}")

    def pop(self) -> list[str]:
        """Return no events."""
        return []


class RemoteDevice:
    """Program, events, variables and run control of the robot of a session. It has no commands: it executes them."""

    def __init__(self, session: Session, number: int) -> None:
        """`number`: that of the robot until it is connected."""
        self.layout = session.program.own.layout
        """Layout that the node has described."""
        self.radio = (0, 0)
        """Channel and network of the radio; a real robot has one of its own, which is not known."""
        self.notices = Notices()
        """Messages for the user."""
        self.load_meter = LoadMeter()
        """Always without counts: a real robot does not report its load."""
        self.variables = RemoteVariables(session)
        self.run_control = RemoteRunControl(session)
        self.local_events = RemoteLocalEvents(self.notices)
        self.due = DueTime()
        """Always now: whatever waits to be sent is sent whenever the owner runs."""
        self.on_run: Callable[[], None] = lambda: None
        """Called where a simulated robot would run: sends the messages that wait."""
        self._session, self._number = session, number
        self._events: list[EmittedEvent] = []

    @property
    def node_id(self) -> int:
        """Number of the robot on its network."""
        return self._number if self._session.node is None else self._session.node.number

    @property
    def status(self) -> DeviceStatus:
        """State of the machine."""
        return self.run_control.status

    @property
    def is_busy(self) -> bool:
        """The robot executes its program itself."""
        return False

    @property
    def has_emitted(self) -> bool:
        """Whether events wait for the owner."""
        return bool(self._events)

    def load(self, program: ThymioProgram) -> None:
        """Load a program and start it; a robot that is not connected gets it from its owner when it is.

        Raises ValueError for a program of another layout.
        """
        if program.layout != self.layout:
            raise ValueError(f"a program for the layout {program.layout} found, expected {self.layout}")
        longer = extended(program, target(self.layout))
        if longer.problem:
            self.notices.add(f"program {program.name}: ROS cannot set lights and sounds beside it: {longer.problem}")
        self.run_control.load(longer)

    def has_bytecode(self, words: Sequence[int]) -> bool:
        """Whether these are the words of the program as it was loaded."""
        return self._session.program.program.words == tuple(words)

    def adopt(self, program: ThymioProgram) -> None:
        """Note that another client has loaded a program."""
        self._session.adopt(RemoteProgram(program, program.program, problem="another client has loaded its program"))

    def feed(self, sensor: str, words: Sequence[int]) -> None:
        """Do nothing: the robot has sensors of its own."""

    def declares(self, event: str) -> bool:
        """Whether the program declares a global event of this name."""
        return any(name == event for name, _ in self._session.program.own.events)

    def receive_event(self, name: str, args: Sequence[int], *, source: int = 0) -> None:
        """Send a global event to the program. Raises KeyError if it does not declare the event."""
        names = [known for known, _ in self._session.program.own.events]
        if name not in names:
            raise KeyError(name)
        self._session.emit(names.index(name), args, source=source)

    def add_emitted(self, number: int, words: tuple[int, ...]) -> None:
        """Add an event that the robot has emitted; those without a name are dropped."""
        events = self._session.program.own.events
        if number >= len(events):
            return
        if len(self._events) >= MAX_EVENTS:
            self.notices.add(f"more events arrive than can be handled: {events[number][0]} is lost")
            return
        self._events.append(EmittedEvent(events[number][0], words))

    def advance(self, now_ns: int) -> None:
        """Do nothing: the robot has a clock of its own."""

    def run(self, budget: int) -> int:
        """Send what waits to be sent; the robot executes its program itself."""
        self.on_run()
        return 0

    def pop_commands(self) -> list[Command]:
        """Return no commands: the robot executes them itself."""
        return []

    def pop_events(self) -> list[EmittedEvent]:
        """Return and clear the emitted events, in order."""
        events, self._events = self._events, []
        return events


class RemoteHost:
    """The selection of a remote robot's program; there is no menu. Invariant: the robot runs `program`."""

    def __init__(self, device: RemoteDevice) -> None:
        self.device = device
        self.program = load_program("", "none", device.layout)
        self._remembered = self.program
        self.behaviour = ""
        """Name of the built-in program that was started last; "" after another program."""
        self.breakpoints: tuple[int, ...] = ()
        """The lines at which the user asked that the user program pauses, from 1."""
        self.own_starts = 0
        """See `RobotHost`."""

    @property
    def user_program(self) -> ThymioProgram:
        """The program that `restart` loads."""
        return self.program

    def load(self, program: ThymioProgram) -> None:
        """Load a user program and start it. Raises ValueError for a program of another layout."""
        self.program, self.behaviour = program, ""
        self.device.load(program)
        if self.breakpoints:
            self.device.run_control.set_breakpoints(self.breakpoints)

    def adopt(self, words: Sequence[int]) -> None:
        """Make the bytecode that another client has loaded the program; it may be the one that is known."""
        if not self.device.has_bytecode(words):
            is_known = self._remembered.program.words == tuple(words)
            foreign = foreign_program(words, self.device.layout, self.program.events)
            self.program = self._remembered if is_known else foreign
            self.breakpoints = ()
            self.device.adopt(self.program)

    def set_breakpoints(self, lines: Sequence[int]) -> None:
        """Replace the breakpoints at lines of the program, also for its next starts."""
        self.breakpoints = tuple(lines)
        self.device.run_control.set_breakpoints(lines)

    def remember(self, program: ThymioProgram) -> None:
        """Remember the text of a program whose bytecode another client loads next."""
        self._remembered = program

    def start(self, name: str, user_program: ThymioProgram | None = None) -> None:
        """Start a built-in program, from which no other can be started.

        Raises FileNotFoundError if there is none of this name, ProgramError if it uses what the robot does not have.
        """
        self.load(built_in(name, self.device.layout))
        self.behaviour = name

    def restart(self) -> None:
        """Load the program again."""
        self.load(self.program)

    def resume(self) -> None:
        """Continue execution; switch a robot that is off on."""
        self.device.run_control.resume()

    def pop_events(self) -> list[EmittedEvent]:
        """Return and clear the emitted events."""
        return [event for event in self.device.pop_events() if not is_internal(event.name)]

    def pop_notices(self) -> list[str]:
        """Return and clear the notices for the user."""
        return self.device.notices.pop()
