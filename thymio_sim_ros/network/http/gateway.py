"""HTTP requests on one side, networks of Aseba nodes on the other, without input and output.

A request starts with `start` or `load`, which call its `reply` at once or when the nodes have answered; `advance` ends
requests that no node answers. Each network is a `NodeClient`, into which its owner feeds messages (`receive`) and from
which it sends `pop_messages` after each call.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from aseba_vm import Program
from aseba_vm.protocol.messages import Message, Reset, Run, UserMessage
from aseba_vm.protocol.node_client import NodeClient
from aseba_vm.protocol.reports import EventReceived, NodeConnected, NodeDisconnected, ProgramLoaded, VariablesRead
from thymio_sim_ros.access import RefusedError
from thymio_sim_ros.network.http.nodes import Directory, Key
from thymio_sim_ros.network.http.programs import Compiled, NodeToLoad
from thymio_sim_ros.network.http.replies import (
    Definitions,
    Reply,
    description_json,
    done,
    json_reply,
    refusal,
    summary_json,
)
from thymio_sim_ros.network.http.requests import (
    Action,
    DescribeNode,
    ListNodes,
    LoadProgram,
    ReadOrSend,
    ResetAll,
    Send,
    StreamEvents,
)
from thymio_sim_ros.network.http.streams import Streams, Subscription

__all__ = ["Gateway"]

TIMEOUT_NS = 3_000_000_000
"""Time in which a node answers, or a program is loaded."""
MAX_WAITING = 256
"""Requests that wait for nodes; further ones are rejected."""
_MOTOR_TARGETS = ("motor.left.target", "motor.right.target")

ReplyTo = Callable[[Reply], None]


@dataclass(slots=True)
class _Read:
    """A request for a variable; words before address `next` have arrived."""

    key: Key
    name: str
    next: int
    end: int
    deadline_ns: int
    reply: ReplyTo


@dataclass(slots=True)
class _Load:
    """A request that ends when these nodes have their programs."""

    missing: set[Key]
    deadline_ns: int
    reply: ReplyTo
    notes: tuple[str, ...]


class Gateway:
    """Requests and streams for all nodes of all networks. Not thread-safe."""

    def __init__(self) -> None:
        """Create a gateway without networks."""
        self._nodes = Directory()
        self._streams = Streams()
        self._reads: list[_Read] = []
        self._loads: list[_Load] = []
        self._now_ns = 0

    @property
    def waiting(self) -> int:
        """Requests that wait for nodes."""
        return len(self._reads) + len(self._loads)

    @property
    def stream_count(self) -> int:
        """Open streams."""
        return len(self._streams)

    def add_network(self, client: NodeClient, robot: str = "") -> int:
        """Add a network, with the name of its robot; return the number by which calls refer to it."""
        return self._nodes.add(client, robot)

    def remove_network(self, network: int) -> None:
        """Remove a network; requests and streams of its nodes end."""
        for node in self._nodes.clients[network].nodes:
            self._fail((network, node), "the node has left the network")
        self._streams.end_of_network(network)
        self._nodes.remove(network)

    def set_program(self, network: int, program: Program, definitions: Definitions) -> None:
        """Set what is known of the program of a network's robot, which another client may have loaded.

        It is out of date if a request loads another one.
        """
        if not any(key[0] == network for load in self._loads for key in load.missing):
            self._nodes.set_program(network, program, definitions)

    def receive(self, network: int, message: Message) -> None:
        """Process a message of a network."""
        client = self._nodes.clients[network]
        for report in client.receive(message):
            match report:
                case VariablesRead(node=node, start=start, values=values):
                    self._finish_read((network, node), start, len(values))
                case ProgramLoaded(node=node):
                    self._finish_load((network, node))
                case EventReceived(source=node, number=number, words=words) if node in client.nodes:
                    name = self._nodes.definitions((network, node)).event_name(number)
                    self._streams.publish((network, node), name, words)
                case NodeConnected(node=node):
                    self._fail((network, node), "the node has started again")
                    self._nodes.apply_program((network, node))
                case NodeDisconnected(node=node):
                    self._fail((network, node), "the node has left the network")

    def advance(self, now_ns: int) -> None:
        """Advance the time: at least every 0.1 s while requests wait, and before a request."""
        self._now_ns = now_ns
        for network, client in self._nodes.clients.items():
            for report in client.advance(now_ns):
                match report:
                    case ProgramLoaded(node=node):
                        self._finish_load((network, node))
                    case NodeDisconnected(node=node):
                        self._fail((network, node), "the node does not answer any more")
        waiting: list[_Read | _Load] = [*self._reads, *self._loads]
        overdue = [request for request in waiting if request.deadline_ns <= now_ns]
        self._end(overdue, f"no answer of the node within {TIMEOUT_NS // 10**9} s")

    def start(self, action: Action, reply: ReplyTo) -> None:
        """Carry out an action except LoadProgram and StreamEvents. Raises RefusedError."""
        match action:
            case ListNodes():
                reply(json_reply([summary_json(view) for view in self._nodes.views().values()]))
            case DescribeNode(node):
                reply(self._describe(node))
            case ReadOrSend(node, name):
                key = self._nodes.find(node)
                if self._nodes.event(key, name) is None:
                    self._read(key, name, reply)
                else:
                    self._send(key, name, ())
                    reply(done())
            case Send(node, name, values):
                self._send(self._nodes.find(node), name, values)
                reply(done())
            case ResetAll():
                self._reset()
                reply(done())
            case LoadProgram() | StreamEvents():
                raise TypeError(f"{type(action).__name__} has a method of its own")

    def is_change(self, action: Action) -> bool:
        """Whether an action changes anything on a node. Raises RefusedError."""
        match action:
            case ReadOrSend(node, name):
                return self._nodes.event(self._nodes.find(node), name) is not None
            case Send() | LoadProgram() | ResetAll():
                return True
        return False

    def nodes_to_load(self, action: LoadProgram) -> list[NodeToLoad]:
        """The nodes for which a file is to be compiled. Raises RefusedError."""
        views = self._nodes.views()
        keys = list(views) if action.node is None else [self._nodes.find(action.node)]
        if not keys:
            raise RefusedError(404, "no node is connected")
        return [
            NodeToLoad(key, view.remote.number, view.remote.description, view.robot)
            for key, view in views.items()
            if key in keys
        ]

    def load(self, compiled: Compiled, reply: ReplyTo) -> None:
        """Load and run programs. Raises RefusedError if a node has left or is another one since `nodes_to_load`."""
        for node, _ in compiled.programs:
            remote = self._nodes.remote(node.key)
            if remote is None or remote.description != node.target:
                raise RefusedError(409, f"node {node.target.name} has left the network or has started again")
        self._check_waiting()
        for node, program in compiled.programs:
            self._nodes.client(node.key).load(node.key[1], program.program)
            self._nodes.define(node.key, compiled.definitions)
        keys = {node.key for node, _ in compiled.programs}
        self._loads.append(_Load(keys, self._now_ns + TIMEOUT_NS, reply, compiled.notes))

    def subscribe(self, action: StreamEvents, send: Callable[[bytes | None], None]) -> Subscription:
        """Open a stream, until `unsubscribe`. Raises RefusedError."""
        key = None if action.node is None else self._nodes.find(action.node)
        return self._streams.open(key, action, send)

    def unsubscribe(self, stream: Subscription) -> None:
        """Close a stream; a second call has no effect."""
        self._streams.close(stream)

    def _describe(self, text: str) -> Reply:
        """A node; an empty array if there is none, as in the reference."""
        try:
            key = self._nodes.find(text)
        except RefusedError as error:
            return Reply(error.status, b"[]")
        return json_reply(description_json(self._nodes.views()[key]))

    def _read(self, key: Key, name: str, reply: ReplyTo) -> None:
        address, size = self._nodes.address(key, name)
        if not size:
            reply(json_reply([]))
            return
        self._check_waiting()
        self._nodes.client(key).read(key[1], [name])
        self._reads.append(_Read(key, name, address, address + size, self._now_ns + TIMEOUT_NS, reply))

    def _send(self, key: Key, name: str, values: Sequence[int]) -> None:
        client = self._nodes.client(key)
        event = self._nodes.event(key, name)
        if event is not None:
            number, size = event
            words = (*values, *(0,) * (size - len(values)))
            client.send(UserMessage(client.source, number, words))
            return
        _, size = self._nodes.address(key, name)
        if not 1 <= len(values) <= size:
            raise RefusedError(400, f"{name}: found {len(values)} values, expected 1 to {size}")
        client.write(key[1], name, values)

    def _reset(self) -> None:
        for client in self._nodes.clients.values():
            for node, remote in client.nodes.items():
                client.send(Reset(client.source, node), Run(client.source, node))
                for name in _MOTOR_TARGETS:
                    if name in remote.addresses:
                        client.write(node, name, (0,))

    def _check_waiting(self) -> None:
        if self.waiting >= MAX_WAITING:
            raise RefusedError(503, f"{MAX_WAITING} requests wait for nodes already; send fewer at the same time")

    def _finish_read(self, key: Key, start: int, count: int) -> None:
        """Complete the oldest request that expects these words; a node on the radio answers in pieces."""
        read = next((read for read in self._reads if read.key == key and read.next == start), None)
        if read is None:
            return
        read.next += count
        if read.next < read.end:
            return
        self._reads.remove(read)
        remote = self._nodes.remote(key)
        value = remote.value(read.name) if remote is not None and read.name in remote.addresses else None
        if value is None:
            read.reply(refusal(RefusedError(409, f"{read.name}: another program has been loaded meanwhile")))
        else:
            read.reply(json_reply(value))

    def _finish_load(self, key: Key) -> None:
        client = self._nodes.client(key)
        if any(key in load.missing for load in self._loads):
            client.send(Run(client.source, key[1]))
        for load in list(self._loads):
            load.missing.discard(key)
            if not load.missing:
                self._loads.remove(load)
                load.reply(done(load.notes))

    def _fail(self, key: Key, reason: str) -> None:
        reads = [read for read in self._reads if read.key == key]
        self._end([*reads, *(load for load in self._loads if key in load.missing)], reason)

    def _end(self, waiting: Sequence[_Read | _Load], reason: str) -> None:
        for request in waiting:
            if isinstance(request, _Read):
                self._reads.remove(request)
            else:
                self._loads.remove(request)
            request.reply(refusal(RefusedError(504, reason)))
