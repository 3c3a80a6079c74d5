"""The devices of some robots: what is done to their programs, which of them run, for how long, who gets their events.

They are simulated, or robots behind a network, which run their programs themselves.

All devices share one Aseba bus; an event is not sent back to its sender. The budget of a tick is for all devices
together, so that programs without an end, on however many robots, leave time for the world.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from aseba_vm.protocol import Message
from thymio_sim_ros.device.behavior_host import BehaviorHost
from thymio_sim_ros.device.costs import PROGRAM_START
from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.network_events import EmittedEvent
from thymio_sim_ros.device.network_node import QUESTIONS, NetworkNode
from thymio_sim_ros.device.programs.foreign import is_unnamed
from thymio_sim_ros.device.programs.program import load_program
from thymio_sim_ros.device.robot_device import RobotDevice, RobotHost, RobotNode
from thymio_sim_ros.engine.inputs import (
    CONTROLS,
    BreakpointsSet,
    ClientConnected,
    ClientDisconnected,
    Controlled,
    DevicesAdded,
    DeviceStart,
    EventSent,
    Loaded,
    MessagesReceived,
    ProgramInput,
    Remembered,
    VariableSet,
)
from thymio_sim_ros.sim.commands import Command

__all__ = ["BUDGET", "MAX_ROUNDS", "TICK_BUDGET", "Devices", "SentMessages"]

BUDGET = 5000
"""Instructions of a device per round of a tick; a longer handler continues in the next."""

MAX_ROUNDS = 10
"""Rounds per tick in which robots may react to events of others; the rest continues in the next tick."""

TICK_BUDGET = 2 * BUDGET
"""Instructions of all devices per tick, in equal parts for those that need them: about a third of a tick's time."""


@dataclass(frozen=True, slots=True)
class SentMessages:
    """Messages of a robot on its Aseba network, for one client or, with None, for all."""

    robot: str
    client: int | None
    messages: Sequence[Message]


class Devices:
    """Runs the devices of robots, in the order in which these were added.

    `emitted` has the events of the last run as (robot, event), in order; `ran` the robots that ran in it.
    """

    def __init__(self, on_program: Callable[[], None] = lambda: None) -> None:
        """`on_program` is called when a robot has changed its own program, as the menu does."""
        self._on_program = on_program
        self.shares_numbers = False
        """See `RunStart`."""
        self.hosts: dict[str, RobotHost] = {}
        """The selection of each robot's program, also of those that are not in the world."""
        self.nodes: dict[str, RobotNode] = {}
        """Each robot as a node of an Aseba network."""
        self.emitted: list[tuple[str, EmittedEvent]] = []
        self.ran: set[str] = set()
        self.runs = 0
        """Number of times that the devices have run."""
        self.present: Mapping[str, RobotDevice] = {}
        """The devices that run: those of the robots that are in the world."""
        self._sent: list[SentMessages] = []
        self._connected: dict[str, set[int]] = {}
        """Clients of the robots that have any."""
        self._owed: dict[str, int] = {}
        """Instructions that robots have executed beyond their share, as one native call may; they wait meanwhile."""

    def create(self, added: DevicesAdded, *, alone: bool) -> dict[str, AsebaDevice]:
        """Create the devices of robots; `begin` then gives them their programs. `alone`: whether there is one robot.

        Raises SdCardError or SettingsError if a folder of the options cannot be used; no device is then changed.
        """
        hosts = {
            name: BehaviorHost(AsebaDevice(node_id=start.number, options=added.options.for_robot(name, alone=alone)))
            for name, start in added.devices.items()
        }
        self.shares_numbers = added.shares_numbers
        self.hosts |= hosts
        self.nodes |= {name: NetworkNode(host, name=name) for name, host in hosts.items()}
        for name in hosts:
            self._connected.pop(name, None)
        return {name: host.device for name, host in hosts.items()}

    def add(self, robot: str, host: RobotHost, node: RobotNode) -> None:
        """Add a robot that runs its program itself."""
        self.hosts[robot], self.nodes[robot] = host, node
        self._connected.pop(robot, None)

    def remove(self, robot: str) -> None:
        """Forget the device of a robot."""
        del self.hosts[robot], self.nodes[robot]
        self._connected.pop(robot, None)

    def begin(self, starts: Mapping[str, DeviceStart]) -> None:
        """Give robots the programs with which they start."""
        for name, start in starts.items():
            host = self.hosts[name]
            self._owed.pop(name, None)
            host.set_breakpoints(start.breakpoints)
            if start.behaviour:
                host.start(start.behaviour, start.program)
            elif start.program is not None:
                host.load(start.program)

    def starts(self) -> dict[str, DeviceStart]:
        """Return the starts of the devices after a reset, by robot."""
        return {
            name: DeviceStart(host.device.node_id, host.user_program, host.behaviour, tuple(host.breakpoints))
            for name, host in self.hosts.items()
        }

    def apply(self, happened: ProgramInput) -> bool:
        """Do what an input says; return whether devices should run at once, since its effect is to be seen.

        Raises KeyError for a robot without a device, an unknown variable or event, and ValueError for a wrong number of
        words or values, or an unknown control.
        """
        match happened:
            case Loaded(robot, program, behaviour):
                host = self.hosts[robot]
                self._owed.pop(robot, None)
                if behaviour:
                    host.start(behaviour, program)
                else:
                    host.load(program or load_program("", "none", host.device.layout))
            case Controlled(robot, action):
                self._control(self.hosts[robot], action)
                self._owed.pop(robot, None)
            case BreakpointsSet(robot, lines):
                self.hosts[robot].set_breakpoints(lines)
                return False
            case VariableSet(robot, variable, words):
                self.hosts[robot].device.variables.set(variable, words)
            case EventSent(robots, event, args, source):
                self._receive_event(robots, event, args, source)
            case Remembered(robot, program):
                self.hosts[robot].remember(program)
                return False
            case ClientConnected(robot, client):
                self.nodes[robot].connect(client)
                self._connected.setdefault(robot, set()).add(client)
                return False
            case ClientDisconnected(robot, client):
                self._disconnect(robot, client)
                return False
            case MessagesReceived(robot, client, messages):
                return self._handle_messages(robot, client, messages)
            case DevicesAdded():
                raise ValueError("devices are added by their engine")
        return True

    @property
    def has_clients(self) -> bool:
        """Whether a robot's network has clients."""
        return bool(self._connected)

    def is_due(self, now_ns: int) -> bool:
        """Whether a device has work at this time."""
        return any(device.due.ns <= now_ns for device in self.present.values())

    def run(self, now_ns: int) -> list[tuple[str, Command]]:
        """Run the devices that are due, and those that receive their events; return their commands, by robot.

        Devices whose budget is used up are still due, and keep their commands.
        """
        self.emitted.clear()
        self.ran.clear()
        self.runs += 1
        due: list[tuple[str, RobotDevice]] = []
        budget = TICK_BUDGET
        for _ in range(MAX_ROUNDS):
            due = [(name, device) for name, device in self.present.items() if device.due.ns <= now_ns]
            if not due:
                break
            for at, (name, device) in enumerate(due):
                if name not in self.ran:
                    self.ran.add(name)
                    device.advance(now_ns)
                budget -= self._run_device(name, device, budget // (len(due) - at))
            senders = [name for name, device in due if device.has_emitted]
            if sum(self._forward_events(name) for name in senders) == 0:
                break
        for robot in self._connected:
            self._send(robot, None, self.nodes[robot].pop_messages())
        return [(name, command) for name, device in due for command in device.pop_commands()]

    def pop_sent(self) -> list[SentMessages]:
        """Return and clear the messages for clients, in order."""
        sent, self._sent = self._sent, []
        return sent

    def _run_device(self, name: str, device: RobotDevice, share: int) -> int:
        """Run a device for its share of the budget, less what it owes; return the part that is used."""
        owed = self._owed.get(name, 0)
        if owed < share:
            owed += device.run(min(BUDGET, share - owed))
        paid = min(owed, share)
        self._owed[name] = owed - paid
        return paid

    def _control(self, host: RobotHost, action: str) -> None:
        if action not in CONTROLS:
            raise ValueError(f"control: found '{action}', expected one of {', '.join(CONTROLS)}")
        if action == "run":
            host.resume()
        else:
            getattr(host.device.run_control, action)()

    def _receive_event(self, robots: Sequence[str], event: str, args: Sequence[int], source: int) -> None:
        sizes = {robot: dict(self.hosts[robot].program.events)[event] for robot in robots}
        for size in sizes.values():
            if len(args) > size:
                raise ValueError(f"event {event}: found {len(args)} values, expected at most {size}")
        for robot, size in sizes.items():
            padded = (*args, *[0] * (size - len(args)))
            self.hosts[robot].device.receive_event(event, padded, source=source)

    def _disconnect(self, robot: str, client: int) -> None:
        self.nodes[robot].disconnect(client)
        clients = self._connected.get(robot, set())
        clients.discard(client)
        if not clients:
            self._connected.pop(robot, None)

    def _handle_messages(self, robot: str, client: int, messages: Sequence[Message]) -> bool:
        """Handle messages of a client; return whether they are more than questions."""
        node = self.nodes[robot]
        for message in messages:
            replies = node.handle(client, message)
            self._send(robot, None, node.pop_messages())
            self._send(robot, client, replies)
        node.install_bytecode()
        return not all(isinstance(message, QUESTIONS) for message in messages)

    def _send(self, robot: str, client: int | None, messages: Sequence[Message]) -> None:
        if messages:
            self._sent.append(SentMessages(robot, client, messages))

    def _forward_events(self, name: str) -> int:
        """Forward the emitted events of a device, or change its program; return how many devices have new work."""
        sender = self.hosts[name]
        running, starts = sender.program, sender.own_starts
        events, radio = sender.pop_events(), sender.device.radio
        woken = sender.own_starts - starts
        if woken:
            self._owed[name] += PROGRAM_START
            self._on_program()
        for event in events:
            self.emitted.append((name, event))
            if not self.shares_numbers and is_unnamed(running, event.name):
                continue
            for device in self.present.values():
                if device is not sender.device and device.radio == radio and device.declares(event.name):
                    device.receive_event(event.name, event.args, source=sender.device.node_id)
                    woken += 1
        return woken
