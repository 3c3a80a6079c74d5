"""The network's side of a robot behind an Aseba network: messages in and out, readings, commands.

The owner connects a stream (`start`), passes messages (`receive`) and time (`poll`), and sends what `pop_messages`
returns. When `connections` has changed, `device.layout` may have, too; the owner then loads the program again.
"""

from __future__ import annotations

from collections.abc import Iterator

from aseba_vm import TargetDescription
from aseba_vm.protocol import Message, printable, reports
from aseba_vm.targets import THYMIO_II
from thymio_sim_ros.device.layout import described, target
from thymio_sim_ros.device.remote.commands import RemoteCommands
from thymio_sim_ros.device.remote.gateway import Gateway
from thymio_sim_ros.device.remote.remote_device import RemoteDevice, RemoteHost
from thymio_sim_ros.device.remote.sensing import RemoteSensing
from thymio_sim_ros.device.remote.session import Session
from thymio_sim_ros.sim.commands import Command, ResetOdometry
from thymio_sim_ros.sim.model.readings import Reading

__all__ = ["RemoteRobot"]


class RemoteRobot:
    """One robot: the first node that answers on a stream. Invariant: `device.layout` is that of the node, if any."""

    def __init__(self, number: int = 1) -> None:
        """`number`: that of the robot until it is connected."""
        self._session = Session(described(THYMIO_II))
        self.device = RemoteDevice(self._session, number)
        """The robot as the owner of programs needs it; a Thymio II until it has described itself."""
        self.host = RemoteHost(self.device)
        """The selection of its program."""
        self.gateway = Gateway(self._session, self.host)
        """The robot as a node for other clients."""
        self.connections = 0
        """Number of times that the robot has connected."""
        self.sensing = RemoteSensing(target(self.device.layout))
        """The sensors of the robot."""
        self._commands = RemoteCommands(self._session)
        self._is_read = False

    @property
    def is_connected(self) -> bool:
        """Whether the robot has answered and described itself."""
        return self._session.node is not None

    @property
    def can_drive(self) -> bool:
        """Whether the robot is connected and has the wheels of a Thymio."""
        return self._commands.can_drive

    @property
    def name(self) -> str:
        """Name, node number and protocol version that the robot reports; empty before it is connected."""
        node = self._session.node
        return (
            "" if node is None else f"{printable(node.description.name)} (node {node.number}, protocol {node.version})"
        )

    @property
    def target(self) -> TargetDescription:
        """Description that the robot has sent; before, that of a Thymio II."""
        return target(self.device.layout)

    @property
    def problem(self) -> str:
        """Why the robot is not connected."""
        return self._session.problem

    def start(self, now_ns: int) -> None:
        """Begin on a new stream; `now_ns` is of a monotonic clock, here and elsewhere."""
        self._session.client.start(now_ns)

    def end(self, reason: str) -> None:
        """Note that the stream has ended, or could not be opened."""
        self._session.problem = reason
        self._process(self._session.client.end(reason))

    def receive(self, message: Message) -> None:
        """Process a message of the stream."""
        self.gateway.add(message)
        self._process(self._session.client.receive(message))

    def poll(self, now_ns: int) -> None:
        """Advance the time and request all variables, unless those requested before have not arrived."""
        self._process(self._session.client.advance(now_ns))
        self._commands.advance(now_ns)
        node = self._session.node
        if node is not None and not node.is_reading:
            self._session.client.read(node.number)

    def pop_messages(self) -> list[Message]:
        """Return and clear the messages to send, in order."""
        return self._session.client.pop_messages()

    def pop_readings(self, stamp_ns: int) -> Iterator[tuple[str, Reading]]:
        """Yield the readings of the sensors that are due if variables have arrived since the last call."""
        if self._is_read and self._session.node is not None:
            self._is_read = False
            yield from self.sensing.readings(self._session.value, stamp_ns)

    def execute(self, command: Command, now_ns: int) -> None:
        """Execute a command. Raises ValueError if the robot cannot do that, or cannot do it now."""
        if isinstance(command, ResetOdometry):
            self.sensing.reset_odometry()
        else:
            self._commands.execute(command, now_ns)

    def _process(self, found: list[reports.Report]) -> None:
        for report in found:
            match report:
                case reports.NodeConnected(node=number):
                    self._connect(number)
                case reports.NodeUnusable(node=number, reason=reason):
                    if self._session.node is None:
                        self._session.problem = f"node {number}: {reason}"
                    self.device.notices.add(f"node {number} cannot be used: {reason}")
                case _ if self._session.node is not None:
                    self._process_own(report, self._session.node.number)

    def _process_own(self, report: reports.Report, own: int) -> None:
        """Process a report if it is about the robot."""
        control = self.device.run_control
        match report:
            case reports.NodeDisconnected(node=node, reason=reason) if node == own:
                self._session.node, self._session.problem = None, reason
                self._commands.forget()
            case reports.VariablesRead(node=node, start=start, values=values) if node == own:
                self._commands.on_read(start, values)
                self._is_read = True
            case reports.EventReceived(source=node, number=number, words=words) if node == own:
                self.device.add_emitted(number, words)
            case reports.StateReported(node=node, state=state) if node == own:
                control.on_state(state)
            case reports.FaultReported(node=node, message=message) if node == own:
                control.on_fault(message)
            case reports.RequestTimedOut(node=node, request=request) if node == own:
                self.device.notices.add(f"the robot does not answer {type(request).__name__}")

    def _connect(self, number: int) -> None:
        session = self._session
        if session.node is not None and session.node.number != number:
            self.device.notices.add(f"node {number} is not used: the robot is node {session.node.number}")
            return
        session.node = session.client.nodes[number]
        layout = described(session.node.description)
        if layout != self.device.layout:
            self.device.layout, self.sensing = layout, RemoteSensing(session.node.description)
        self.sensing.reconnect()
        self._commands.forget()
        self.connections += 1
