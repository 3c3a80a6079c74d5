"""The device manager: clients on one side, Aseba networks on the other, and time; no I/O.

Everything that arrives is passed to `receive` or `receive_from_network`, time to `advance`; afterwards `pop_deliveries`
and `pop_messages` have what is to be sent. `requests` has one function for each request of a client, `reports` one
for each report of a network.

Source: docs/spec/aseba-protocol.md section 2.3.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from uuid import UUID, uuid4

from aseba_vm.protocol.messages import GetDeviceInfo, GetExecutionState, printable
from aseba_vm.protocol.messages import Message as AsebaMessage
from aseba_vm.protocol.node_client import NodeClient
from aseba_vm.protocol.reports import EventReceived, NodeConnected, NodeDisconnected, Report
from thymio_sim_ros.device.programs.program import ThymioProgram
from thymio_sim_ros.network.tdm.conversation import reports, requests
from thymio_sim_ros.network.tdm.conversation.breakpoints import answer_breakpoints
from thymio_sim_ros.network.tdm.conversation.clients import Client, Closing, Delivery
from thymio_sim_ros.network.tdm.conversation.directory import Directory
from thymio_sim_ros.network.tdm.conversation.group import Group
from thymio_sim_ros.network.tdm.conversation.handshake import ManagerSettings, greet
from thymio_sim_ros.network.tdm.conversation.managed_node import ManagedNode
from thymio_sim_ros.network.tdm.conversation.program_requests import finish_compilation
from thymio_sim_ros.network.tdm.conversation.programs import Compilation, Compiled
from thymio_sim_ros.network.tdm.protocol.constants import NodeType, Watch
from thymio_sim_ros.network.tdm.protocol.messages import CompilationResultFailure, Message, Ping

__all__ = ["DeviceManager"]

_MS = 1_000_000
PING_PERIOD_NS = 2500 * _MS
"""tdmclient needs some message to end: its reader has no time-out (docs/spec/aseba-protocol.md section 2.3)."""
POLL_PERIOD_NS = 100 * _MS
"""Time between two requests for the variables of a node that is watched."""
PATIENCE_NS = 3000 * _MS
"""Time for the replies of a node."""
GREETING_NS = 10_000 * _MS
"""Time for the handshake of a client."""
_DEVICE_NAME = 2
"""Kind of the device's information."""
_FIRST_VERSION_WITH_INFO = 6


@dataclass(slots=True)
class _Network:
    """An Aseba network: our client on it, and the group that its nodes form."""

    link: NodeClient
    group: Group
    kind: NodeType
    name: str
    """Name of its nodes; empty: that of their descriptions."""
    ids: dict[int, UUID] = field(default_factory=dict)
    """Ids of its nodes by number; a node that returns keeps its id."""


class DeviceManager:
    """All clients, networks and nodes. The time, in ns, never goes back."""

    def __init__(self, settings: ManagerSettings, now_ns: int, *, new_id: Callable[[], UUID] = uuid4) -> None:
        """`now_ns`: time since 1970, which clients get with values; `new_id`: source of ids."""
        self._settings = settings
        self._new_id = new_id
        self._directory = Directory()
        self._directory.now_ns = now_ns
        self._networks: dict[int, _Network] = {}
        self._next_ping_ns = now_ns + PING_PERIOD_NS
        self._next_poll_ns = now_ns

    def add_network(self, number: int, *, kind: NodeType, name: str = "") -> None:
        """Begin to speak with an Aseba network, whose nodes are of one kind and have this name, or their own."""
        network = _Network(NodeClient(), Group(self._new_id()), kind, name)
        network.link.start(self._directory.now_ns)
        self._networks[number] = network

    def remove_network(self, number: int, reason: str) -> None:
        """End the nodes of a network."""
        self._handle(number, self._networks[number].link.end(reason))
        del self._networks[number]

    def receive_from_network(self, number: int, message: AsebaMessage) -> None:
        """Process a message of a node."""
        self._handle(number, self._networks[number].link.receive(message))

    def join(self, client: int, *, is_local: bool) -> None:
        """Add a connection, which must begin with a handshake."""
        self._directory.clients.add(Client(client, is_local, self._directory.now_ns))

    def is_greeted(self, client: int) -> bool:
        """Whether a connection has given its handshake and was not rejected."""
        found = self._directory.clients.get(client)
        return found is not None and found.is_greeted

    def leave(self, client: int) -> None:
        """Remove a connection and take its nodes back."""
        self._directory.clients.remove(client)
        for node in self._directory.nodes.values():
            if node.locker == client:
                requests.release(self._directory, node)

    def receive(self, client: int, message: Message) -> Compilation | None:
        """Process a message of a client.

        A compilation is to be executed before the client's next message, its result to be passed to
        `finish_compilation`.
        """
        sender = self._directory.clients.get(client)
        if sender is None:
            return None
        if not sender.is_greeted:
            greet(self._directory, sender, message, self._settings)
            return None
        handler = requests.HANDLERS.get(type(message))
        return None if handler is None else handler(self._directory, sender, message)

    def finish_compilation(self, compilation: Compilation, result: Compiled | CompilationResultFailure) -> None:
        """Answer a request with the result of its compilation."""
        finish_compilation(self._directory, compilation, result)

    def set_congested(self, client: int, *, is_congested: bool) -> None:
        """Leave out changes of variables for a slow client, or send all variables again that it has missed."""
        slow = self._directory.clients.get(client)
        if slow is None:
            return
        slow.is_congested = is_congested
        if not is_congested:
            missed, slow.outdated = slow.outdated, set()
            for node in (self._directory.node(key) for key in sorted(missed)):
                if node is not None and slow.watches(node.id, Watch.VARIABLES):
                    self._directory.clients.send(client, node.all_variables(self._directory.time_ms))

    def advance(self, now_ns: int) -> None:
        """Advance the time: ping clients, request variables that are watched, give up what is not answered."""
        directory = self._directory
        directory.now_ns = now_ns
        for number, network in list(self._networks.items()):
            self._handle(number, network.link.advance(now_ns))
        for client in directory.clients:
            if not client.is_greeted and now_ns - client.joined_ns >= GREETING_NS:
                directory.clients.close(client.number, f"no handshake within {GREETING_NS // (1000 * _MS)} s")
        for node in directory.nodes.values():
            if node.breakpoints is not None and now_ns - node.breakpoints.sent_ns >= PATIENCE_NS:
                answer_breakpoints(directory, node)
        if now_ns >= self._next_poll_ns:
            self._next_poll_ns = now_ns + POLL_PERIOD_NS
            for node in directory.nodes.values():
                if directory.clients.are_watching(node.id, Watch.VARIABLES):
                    node.request_values()
        if now_ns >= self._next_ping_ns:
            self._next_ping_ns = now_ns + PING_PERIOD_NS
            directory.clients.broadcast(lambda client: Ping())

    def pop_deliveries(self) -> list[Delivery | Closing]:
        """The pending deliveries to clients, in order. They are removed from the queue."""
        return self._directory.clients.pop()

    def pop_programs(self) -> list[tuple[int, ThymioProgram]]:
        """The programs that `pop_messages` loads, each with its network number. They are removed from the queue."""
        programs, self._directory.programs = self._directory.programs, []
        return programs

    def pop_messages(self) -> list[tuple[int, AsebaMessage]]:
        """The messages for networks in order, each with the number of its network. They are removed from the queue."""
        return [
            (number, message) for number, network in self._networks.items() for message in network.link.pop_messages()
        ]

    def _handle(self, number: int, found: list[Report]) -> None:
        network = self._networks[number]
        for report in found:
            source = report.source if isinstance(report, EventReceived) else report.node
            node = self._directory.node(network.ids.get(source))
            if isinstance(report, NodeConnected):
                self._connect(number, network, report.node)
            elif isinstance(report, NodeDisconnected):
                if node is not None:
                    reports.remove_node(self._directory, node)
            elif node is not None:
                reports.handle(self._directory, node, report)

    def _connect(self, number: int, network: _Network, address: int) -> None:
        """Add a node, or replace it if it describes itself anew."""
        known = self._directory.node(network.ids.get(address))
        if known is not None:
            reports.remove_node(self._directory, known)
        key = network.ids.setdefault(address, self._new_id())
        remote = network.link.nodes[address]
        name = network.name or printable(remote.description.name)
        node = ManagedNode(key, network.group, number, network.link, remote, kind=network.kind, name=name)
        self._directory.nodes[key] = node
        source = network.link.source
        network.link.send(GetExecutionState(source, address))
        if network.kind is not NodeType.SIMULATED_THYMIO and remote.version >= _FIRST_VERSION_WITH_INFO:
            network.link.send(GetDeviceInfo(source, address, _DEVICE_NAME))
        node.read_firmware()
        self._directory.announce(node)
