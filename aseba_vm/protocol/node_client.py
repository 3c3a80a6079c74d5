"""The client's side of the nodes of one Aseba network, without input and output.

A user connects a stream and then repeats, in any order: `receive` each message that arrives, `advance` the time at
least every 0.1 s, make requests, and after each of these send the messages that `pop_messages` returns:

    client = NodeClient()
    client.start(now_ns)
    reports = client.receive(decode(frame))     # NodeConnected(node=1)
    client.load(1, compile(text, client.nodes[1].description))
    client.send(Run(client.source, 1))
    client.read(1, ["prox.horizontal"])         # later VariablesRead; client.nodes[1].value("prox.horizontal")
    stream.write(b"".join(map(encode, client.pop_messages())))

Nodes are found by LIST_NODES once per second, and are gone after three seconds of silence (docs/spec/aseba-protocol.md
sections 1.4 and 1.5). Messages of other clients, which switches pass on, do no harm.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

from aseba_vm.frontend.pipeline import Program
from aseba_vm.protocol import reports, requests
from aseba_vm.protocol.description_assembly import DescriptionAssembly
from aseba_vm.protocol.messages import (
    PROTOCOL_VERSION,
    ArrayAccessOutOfBounds,
    BreakpointSetResult,
    Command,
    Description,
    DeviceInfo,
    Disconnected,
    DivisionByZero,
    EventExecutionKilled,
    ExecutionStateChanged,
    GetDescription,
    GetNodeDescription,
    GetVariables,
    ListNodes,
    LocalEventDescription,
    Message,
    NamedVariable,
    NativeFunctionDescription,
    NodePresent,
    NodeSpecificError,
    SetBytecode,
    UserMessage,
    Variables,
)
from aseba_vm.protocol.remote_node import RemoteNode
from aseba_vm.protocol.reports import STEP_BY_STEP, ExecutionState, Report

__all__ = ["NodeClient"]

SECOND_NS = 1_000_000_000
LIST_PERIOD_NS = SECOND_NS
SILENCE_NS = 3 * SECOND_NS
"""Time without a message after which a node is gone, and after which a request is not expected to be answered."""
DESCRIPTION_PAUSE_NS = 2 * SECOND_NS
"""Pause in a description after which it is requested again."""
MAX_NODES = 256
"""Further nodes are ignored."""


@dataclass(slots=True)
class _Presence:
    """A node from which messages have arrived: its announced version, and the state of its description."""

    version: int
    heard_ns: int
    asked_ns: int | None = None
    """When its description was requested, or its last item arrived; None if nothing is expected."""
    assembly: DescriptionAssembly | None = None
    is_reported: bool = False
    """Whether the user knows that the description does not arrive."""

    @property
    def missing(self) -> str:
        """A text about the missing parts of the description, for the user."""
        return "nothing has arrived" if self.assembly is None else self.assembly.missing


@dataclass(slots=True)
class _Load:
    """Parts of a program that are not confirmed yet; the last message, and when it was sent."""

    missing: int
    confirmed: int
    last: SetBytecode
    sent_ns: int


class NodeClient:
    """All nodes that answer on one stream. Invariant: `nodes` are those with a complete description."""

    def __init__(self, *, source: int = 0, version: int = PROTOCOL_VERSION) -> None:
        """`source`: number of this client in its messages; `version`: that of the protocol it states."""
        self.source = source
        self._version = version
        self._nodes: dict[int, RemoteNode] = {}
        self._presences: dict[int, _Presence] = {}
        self._loads: dict[int, _Load] = {}
        self._outbox: list[Message] = []
        self._now_ns = 0
        self._next_list_ns = 0

    @property
    def nodes(self) -> Mapping[int, RemoteNode]:
        """The connected nodes by id."""
        return MappingProxyType(self._nodes)

    def start(self, now_ns: int) -> None:
        """Begin on a new stream: ask all nodes whether they are there."""
        self.end("")
        self._outbox.clear()
        self._next_list_ns = now_ns
        self.advance(now_ns)

    def end(self, reason: str) -> list[Report]:
        """Forget all nodes, because the stream has ended."""
        changes = [report for number in list(self._presences) for report in self._forget(number, reason)]
        self._outbox.clear()
        return changes

    def pop_messages(self) -> list[Message]:
        """The messages to send, in order. They are removed from the queue."""
        messages, self._outbox = self._outbox, []
        return messages

    def send(self, *messages: Message) -> None:
        """Send any messages, such as `Run(client.source, 1)`; those that expect values count as reads."""
        for message in messages:
            if isinstance(message, GetVariables) and message.node in self._nodes:
                self._nodes[message.node].expect(message, self._now_ns)
            self._outbox.append(message)

    def load(self, node: int, program: Program) -> None:
        """Load a program, which the node then holds at the start of its init event; ProgramLoaded follows.

        Raises KeyError for a node that is not connected.
        """
        self._nodes[node].set_program(program)
        parts = requests.set_bytecode(node, program.words, source=self.source)
        self._loads[node] = _Load(len(parts), 0, parts[-1], self._now_ns)
        self.send(*parts)

    def note_program(self, node: int, program: Program) -> None:
        """Use the names of a program that another client has loaded. Does nothing for a node that is not connected."""
        if node in self._nodes:
            self._nodes[node].set_program(program)

    def read(self, node: int, names: Iterable[str] | None = None) -> None:
        """Request variables by name, or all that are known; VariablesRead follow.

        Raises KeyError for an unknown name, or a node that is not connected.
        """
        self.send(*requests.read_ranges(node, self._nodes[node].places(names), source=self.source))

    def write(self, node: int, name: str, values: Sequence[int]) -> None:
        """Write a variable from its beginning; it may be shorter than the variable.

        Raises KeyError for an unknown name, or a node that is not connected, ValueError for too many values.
        """
        known = self._nodes[node]
        address, size = known.addresses[name]
        if len(values) > size:
            raise ValueError(f"{name}: found {len(values)} words, expected at most {size}")
        known.write(address, values)
        self.send(*requests.set_variables(node, address, values, source=self.source))

    def advance(self, now_ns: int) -> list[Report]:
        """Advance the time: look for nodes, give up those that are silent and requests that are not answered."""
        self._now_ns = now_ns
        if now_ns >= self._next_list_ns:
            self._next_list_ns = now_ns + LIST_PERIOD_NS
            self.send(ListNodes(self.source, self._version))
        changes: list[Report] = []
        for number, presence in list(self._presences.items()):
            if now_ns - presence.heard_ns >= SILENCE_NS:
                changes += self._forget(number, f"no answer for {SILENCE_NS // SECOND_NS} s")
            elif presence.asked_ns is not None and now_ns - presence.asked_ns >= DESCRIPTION_PAUSE_NS:
                changes += self._complain(number, presence, f"its description has stopped: {presence.missing}")
                self._ask(number, presence)
        for number, node in self._nodes.items():
            for start, count in node.overdue(now_ns - SILENCE_NS):
                changes.append(reports.RequestTimedOut(number, GetVariables(self.source, number, start, count)))
        for number, load in list(self._loads.items()):
            if now_ns - load.sent_ns >= SILENCE_NS:
                del self._loads[number]
                # some nodes report their state once for all parts
                is_loaded = load.confirmed > 0
                changes.append(
                    reports.ProgramLoaded(number) if is_loaded else reports.RequestTimedOut(number, load.last)
                )
        return changes

    def receive(self, message: Message) -> list[Report]:
        """Process a message; the reports say what has changed by it."""
        number = message.source
        if isinstance(message, UserMessage):
            return [reports.EventReceived(number, message.number, message.words)]
        if isinstance(message, Disconnected):
            return self._forget(number, "it has left the network")
        if isinstance(message, NodePresent | Description):
            return self._receive_presence(message)
        presence = self._presences.get(number)
        if presence is None or isinstance(message, Command | ListNodes | GetDescription):
            return []
        presence.heard_ns = self._now_ns
        if isinstance(message, NamedVariable | LocalEventDescription | NativeFunctionDescription):
            if presence.assembly is not None:
                presence.assembly.add(message)
                presence.asked_ns = self._now_ns
            return self._complete(number, presence)
        node = self._nodes.get(number)
        return [] if node is None else self._receive_of(node, message)

    def _receive_presence(self, message: NodePresent | Description) -> list[Report]:
        number = message.source
        presence = self._presences.get(number)
        if presence is None:
            if len(self._presences) >= MAX_NODES:
                return []
            presence = self._presences[number] = _Presence(message.version, self._now_ns)
        presence.heard_ns, presence.version = self._now_ns, message.version
        if isinstance(message, Description):
            presence.assembly, presence.asked_ns = DescriptionAssembly(message), self._now_ns
            return self._complete(number, presence)
        if number not in self._nodes and presence.asked_ns is None:
            self._ask(number, presence)
        return []

    def _receive_of(self, node: RemoteNode, message: Message) -> list[Report]:
        number = node.number
        match message:
            case Variables(start=start, values=values):
                written = node.finish_read(start, len(values))
                return [reports.VariablesRead(number, start, values, node.store(start, values, written))]
            case ExecutionStateChanged(pc=pc, flags=flags):
                return self._receive_state(node, ExecutionState(pc, flags))
            case EventExecutionKilled():
                return [reports.FaultReported(number, message)]
            case ArrayAccessOutOfBounds() | DivisionByZero() | NodeSpecificError():
                node.state = ExecutionState(message.pc, STEP_BY_STEP)
                return [reports.FaultReported(number, message)]
            case BreakpointSetResult(pc=pc, success=success):
                return [reports.BreakpointReported(number, pc, bool(success))]
            case DeviceInfo(kind=kind, data=data):
                return [reports.DeviceInfoReceived(number, kind, data)]
        return []

    def _receive_state(self, node: RemoteNode, state: ExecutionState) -> list[Report]:
        node.state = state
        changes: list[Report] = [reports.StateReported(node.number, state)]
        load = self._loads.get(node.number)
        if load is not None:
            load.confirmed += 1
            if load.confirmed >= load.missing:
                del self._loads[node.number]
                changes.append(reports.ProgramLoaded(node.number))
        return changes

    def _ask(self, number: int, presence: _Presence) -> None:
        presence.assembly, presence.asked_ns = None, self._now_ns
        self.send(GetNodeDescription(self.source, number, self._version))

    def _complete(self, number: int, presence: _Presence) -> list[Report]:
        """Connect a node whose description is complete, unless it is known already."""
        assembly = presence.assembly
        if assembly is None or assembly.missing:
            return []
        presence.assembly = presence.asked_ns = None
        target = assembly.target
        known = self._nodes.get(number)
        if known is not None and known.description == target:
            return []
        if target.variables_end > target.variables_size:
            return self._complain(
                number,
                presence,
                f"describes {target.variables_end} words of variables, more than its {target.variables_size}",
            )
        self._nodes[number] = RemoteNode(number, presence.version, target)
        self._loads.pop(number, None)
        return [reports.NodeConnected(number)]

    @staticmethod
    def _complain(number: int, presence: _Presence, reason: str) -> list[Report]:
        if presence.is_reported:
            return []
        presence.is_reported = True
        return [reports.NodeUnusable(number, reason)]

    def _forget(self, number: int, reason: str) -> list[Report]:
        presence = self._presences.pop(number, None)
        self._loads.pop(number, None)
        if self._nodes.pop(number, None) is not None:
            return [reports.NodeDisconnected(number, reason)]
        if presence is None or presence.asked_ns is None:
            return []
        return self._complain(number, presence, f"{reason} before its description was complete: {presence.missing}")
