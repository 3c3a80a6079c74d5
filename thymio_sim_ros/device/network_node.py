"""A robot as a node of an Aseba network: its answers to the messages of tools, and the messages that it sends by
itself.

Source: docs/spec/aseba-protocol.md section 1.4, with the version that the client states (section 1.2). Bytecode that a
tool writes becomes the program of the robot (`programs/foreign.py`).
"""

from __future__ import annotations

import struct
from collections.abc import Iterator

from aseba_vm import Variable, machine_messages, protocol
from aseba_vm.protocol import MAX_PAYLOAD, MAX_WORDS, PROTOCOL_VERSION, Message, device_name
from thymio_sim_ros.device.behavior_host import BehaviorHost, is_internal
from thymio_sim_ros.device.layout import target

__all__ = ["QUESTIONS", "NetworkNode"]

QUESTIONS = (
    protocol.ListNodes,
    protocol.GetDescription,
    protocol.GetNodeDescription,
    protocol.GetDescriptionFragment,
    protocol.GetVariables,
    protocol.GetChangedVariables,
    protocol.GetExecutionState,
    protocol.GetDeviceInfo,
)
"""Messages that change nothing."""

PAUSING = (protocol.Pause, protocol.Step, protocol.Reset)
"""Messages after which the next event waits before its first instruction."""

UUID, NAME, RADIO = 1, 2, 3
"""Kinds of device data."""

MAX_NAME = 54
"""Maximum length of the name in bytes."""

_OLD_VERSION = 4
"""Last version in which nodes answer a request for the descriptions of all nodes."""
_MAX_TEXT = 255
_MAX_DESCRIPTION = 200
"""Bytes of the description of an event or a native function, so that its message fits a payload."""
_MAX_EVENT_WORDS = MAX_PAYLOAD // 2


class NetworkNode:
    """The node of one robot. Invariant: the machine's messages are collected only while there are clients.

    Only for the thread that owns the device.
    """

    def __init__(self, host: BehaviorHost, *, name: str = "", uuid: bytes = bytes(16)) -> None:
        """`name` and `uuid` (16 bytes) are data of the device, which clients from version 6 on can request."""
        self.name = name
        self._uuid = uuid
        self._host = host
        self._device = host.device
        self._control = host.device.run_control
        self._outbox: list[Message] = []
        self._breakpoints: dict[int, set[int]] = {}
        """Addresses by client."""
        self._seen: dict[int, tuple[int, ...]] = {}
        """The variables that a client has been sent as changes."""
        self._length = 0
        """Number of words of bytecode that a client has written; 0 if they are those of the host's program."""

    def connect(self, client: int) -> None:
        """Add a client; from the first one on, messages are collected."""
        if not self._breakpoints:
            self._control.process_messages()
            self._control.observe = self._observe
        self._breakpoints.setdefault(client, set())

    def disconnect(self, client: int) -> None:
        """Remove a client and its breakpoints; the program continues."""
        addresses = self._breakpoints.pop(client, set())
        self._seen.pop(client, None)
        for pc in addresses.difference(*self._breakpoints.values()):
            self._control.remove_breakpoint(pc)
        if not self._breakpoints:
            self._control.observe = None
            self._outbox.clear()

    def pop_messages(self) -> list[Message]:
        """Return and clear the messages for all clients: events of the program, states of the machine, faults."""
        if not self._breakpoints:
            return []
        self._control.process_messages()
        messages, self._outbox = self._outbox, []
        return messages

    def install_bytecode(self) -> None:
        """Make written bytecode the program of the robot. `handle` does it before all but further bytecode."""
        if self._length:
            words, self._length = self._device.bytecode[: self._length], 0
            self._host.adopt(words)

    def handle(self, client: int, message: Message) -> list[Message]:
        """Execute a message of a client and return the replies for this client. Raises no error for any message."""
        if isinstance(message, protocol.Command) and message.node != self._device.node_id:
            return []
        if isinstance(message, protocol.SetBytecode):
            self._set_bytecode(message)
            return []
        self.install_bytecode()
        return list(self._reply(client, message))

    def _reply(self, client: int, message: Message) -> Iterator[Message]:
        node = self._device.node_id
        match message:
            case protocol.UserMessage():
                self._receive(message)
            case protocol.ListNodes():
                yield protocol.NodePresent(node, min(message.version, PROTOCOL_VERSION))
            case protocol.GetDescription():
                if message.version <= _OLD_VERSION:
                    yield from self._description(message.version)
            case protocol.GetNodeDescription():
                yield from self._description(message.version)
            case protocol.GetDescriptionFragment():
                yield from self._fragment(message)
            case protocol.GetVariables():
                yield from self._variables(message)
            case protocol.SetVariables():
                self._device.variables.write(message.start, message.values)
            case protocol.GetChangedVariables():
                yield from self._changed_variables(client)
            case protocol.GetExecutionState():
                yield self._control_state()
            case protocol.SetBreakpoint():
                yield self._set_breakpoint(client, message.pc)
            case protocol.ClearBreakpoint():
                self._clear_breakpoints({message.pc})
            case protocol.ClearAllBreakpoints():
                self._clear_breakpoints(set().union(*self._breakpoints.values()))
            case protocol.GetDeviceInfo():
                yield from self._device_info(message.kind)
            case protocol.SetDeviceInfo():
                if message.kind == NAME:
                    self.name = protocol.printable(message.data[:MAX_NAME].decode(errors="ignore"))
            case _:
                self._run_control(message)
                if isinstance(message, PAUSING):
                    self._control.stops_at_events = True

    def _run_control(self, message: Message) -> None:
        match message:
            case protocol.Run():
                self._host.resume()
            case protocol.Pause():
                self._control.pause()
            case protocol.Step():
                self._control.step_instruction()
            case protocol.Stop():
                self._control.stop()
            case protocol.Reset():
                self._control.reset()
            case protocol.Reboot():
                self._host.restart()

    def _control_state(self) -> Message:
        pc, flags = self._control.machine_state
        return protocol.ExecutionStateChanged(self._device.node_id, pc, flags)

    def _receive(self, message: protocol.UserMessage) -> None:
        """Pass an event to the program, unless it is one of those that stay inside the robot."""
        events = self._host.program.events
        if message.number >= len(events) or not is_internal(events[message.number][0]):
            self._device.receive_number(message.number, message.words, source=message.source)

    def _set_bytecode(self, message: protocol.SetBytecode) -> None:
        """Write words as far as the memory reaches; a part that begins at 0 begins a program."""
        words = message.words[: max(target(self._device.layout).bytecode_size - message.start, 0)]
        if not words:
            return
        end = message.start + len(words)
        before = self._length or len(self._host.program.program.words)
        self._length = end if message.start == 0 else max(end, before)
        self._device.write_bytecode(words, message.start)
        self._control.stops_at_events = True

    def _description(self, version: int) -> Iterator[Message]:
        yield self._header(version)
        yield from self._items()

    def _fragment(self, message: protocol.GetDescriptionFragment) -> Iterator[Message]:
        """The header (-1), everything (-2), or one item."""
        if message.fragment < 0:
            yield self._header(message.version)
        if message.fragment == -2:
            yield from self._items()
        elif message.fragment >= 0:
            yield from list(self._items())[message.fragment : message.fragment + 1]

    def _header(self, version: int) -> Message:
        described = target(self._device.layout)
        return protocol.Description(
            self._device.node_id,
            _cut(described.name, _MAX_TEXT),
            min(version, PROTOCOL_VERSION),
            described.bytecode_size,
            described.stack_size,
            described.variables_size,
            len(described.variables),
            len(described.local_events),
            len(described.natives),
        )

    def _items(self) -> Iterator[Message]:
        """Variables, events and native functions, in the order in which bytecode refers to them."""
        described, node = target(self._device.layout), self._device.node_id
        variables: tuple[Variable, ...] = described.variables
        for variable in variables:
            yield protocol.NamedVariable(node, variable.size, _cut(variable.name, _MAX_TEXT))
        for event in described.local_events:
            text = _cut(event.description, _MAX_DESCRIPTION)
            yield protocol.LocalEventDescription(node, _cut(event.name, _MAX_TEXT), text)
        for native in described.natives:
            text = _cut(native.description, _MAX_DESCRIPTION)
            yield protocol.NativeFunctionDescription(node, _cut(native.name, _MAX_TEXT), text, native.parameters)

    def _variables(self, message: protocol.GetVariables) -> Iterator[Message]:
        """The words that exist, in as many messages as they need."""
        words = self._device.variables.read(message.start, message.count)
        for offset in range(0, max(len(words), 1), MAX_WORDS):
            part = words[offset : offset + MAX_WORDS]
            yield protocol.Variables(self._device.node_id, message.start + offset, part)

    def _changed_variables(self, client: int) -> Iterator[Message]:
        """The ranges that changed since the last request of the client; everything at its first one."""
        words = self._device.variables.read(0, target(self._device.layout).variables_size)
        before = self._seen.get(client)
        if client in self._breakpoints:
            self._seen[client] = words
        ranges = _changes(before, words)
        if not ranges:
            yield protocol.ChangedVariables(self._device.node_id, ())
        # Each range takes two words in addition to its own.
        part: list[tuple[int, tuple[int, ...]]] = []
        used = 0
        for start, values in ranges:
            for offset in range(0, len(values), MAX_WORDS):
                piece = values[offset : offset + MAX_WORDS]
                if used + len(piece) + 2 > _MAX_EVENT_WORDS:
                    yield protocol.ChangedVariables(self._device.node_id, tuple(part))
                    part, used = [], 0
                part.append((start + offset, piece))
                used += len(piece) + 2
        if part:
            yield protocol.ChangedVariables(self._device.node_id, tuple(part))

    def _set_breakpoint(self, client: int, pc: int) -> Message:
        is_set = self._control.add_breakpoint(pc)
        if is_set and client in self._breakpoints:
            self._breakpoints[client].add(pc)
        return protocol.BreakpointSetResult(self._device.node_id, pc, int(is_set))

    def _clear_breakpoints(self, addresses: set[int]) -> None:
        for pc in addresses:
            self._control.remove_breakpoint(pc)
        for own in self._breakpoints.values():
            own -= addresses

    def _device_info(self, kind: int) -> Iterator[Message]:
        node = self._device.node_id
        _, network = self._device.services.network
        data = {
            UUID: self._uuid,
            NAME: device_name(_cut(self.name, MAX_NAME)),
            RADIO: struct.pack("<HHH", network & 0xFFFF, node, 0xFFFF),
        }
        if kind in data:
            yield protocol.DeviceInfo(node, kind, data[kind])

    def _observe(self, message: machine_messages.Message) -> None:
        """Collect a message of the machine as one of the network."""
        node = self._device.node_id
        match message:
            case machine_messages.Emitted(number, arguments):
                events = self._host.program.events
                if number >= len(events) or not is_internal(events[number][0]):
                    self._outbox.append(protocol.UserMessage(node, number, arguments[:_MAX_EVENT_WORDS]))
            case machine_messages.ExecutionState(pc, flags):
                self._outbox.append(protocol.ExecutionStateChanged(node, pc, flags))
            case machine_messages.EventKilled(pc):
                self._outbox.append(protocol.EventExecutionKilled(node, pc))
            case machine_messages.DivisionByZero(pc):
                self._outbox.append(protocol.DivisionByZero(node, pc))
            case machine_messages.OutOfBounds(pc, size, index):
                # Clients of version 5 abort on a message without size and index.
                signed = (((index or 0) + 0x8000) & 0xFFFF) - 0x8000
                self._outbox.append(protocol.ArrayAccessOutOfBounds(node, pc, size or 0, signed))
            case machine_messages.NodeSpecific(pc) | machine_messages.BadCode(pc):
                self._outbox.append(protocol.NodeSpecificError(node, pc, _cut(message.message, _MAX_TEXT)))


def _cut(text: str, size: int) -> str:
    """Return as much of a text as fits `size` bytes of UTF-8."""
    return text.encode(errors="replace")[:size].decode(errors="ignore")


def _changes(before: tuple[int, ...] | None, words: tuple[int, ...]) -> list[tuple[int, tuple[int, ...]]]:
    """Return start and values of each range of words that differ."""
    if before is None:
        return [(0, words)]
    ranges = []
    start = None
    for place in range(len(words) + 1):
        differs = place < len(words) and words[place] != before[place]
        if differs and start is None:
            start = place
        elif not differs and start is not None:
            ranges.append((start, words[start:place]))
            start = None
    return ranges
