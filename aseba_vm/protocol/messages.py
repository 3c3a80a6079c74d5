"""One frozen dataclass per message of an Aseba network, and both directions of their encoding.

The fields after `source` are the payload in order. Source: docs/spec/aseba-protocol.md section 1.3.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from dataclasses import fields as fields_of
from functools import cache
from typing import Any, ClassVar, get_type_hints

from aseba_vm.protocol import fields
from aseba_vm.protocol.errors import ProtocolError
from aseba_vm.protocol.framing import HEADER_SIZE, LARGEST_PAYLOAD

#: The newest version of the protocol that this package speaks.
PROTOCOL_VERSION = 9
#: Maximum number of words of a range: a payload of 516 bytes with two words before them.
MAX_WORDS = 256
#: Types below are user messages.
FIRST_SYSTEM_TYPE = 0x8000

_HEADER = struct.Struct("<HHH")


@dataclass(frozen=True, slots=True)
class Message:
    """A message; `source` is the id of the node that sent it, or the number of a client (usually 0 or 1)."""

    source: int


@dataclass(frozen=True, slots=True)
class UserMessage(Message):
    """An event of programs. `number` is its index in the shared list of events, 0..32767."""

    number: int
    words: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class UnknownMessage(Message):
    """A message whose type (above 0x7FFF) this package does not know."""

    type: int
    payload: bytes = b""


@dataclass(frozen=True, slots=True)
class Command(Message):
    """A message to one node; all other nodes ignore it."""

    node: fields.U16


# Boot loader; only hardware has one.


@dataclass(frozen=True, slots=True)
class BootloaderReset(Command):
    """Leave the boot loader."""

    TYPE: ClassVar = 0x8000


@dataclass(frozen=True, slots=True)
class BootloaderReadPage(Command):
    """Read a page of the flash memory."""

    TYPE: ClassVar = 0x8001
    page: fields.U16


@dataclass(frozen=True, slots=True)
class BootloaderWritePage(Command):
    """Write a page of the flash memory; its data follow."""

    TYPE: ClassVar = 0x8002
    page: fields.U16


@dataclass(frozen=True, slots=True)
class BootloaderWritePageData(Command):
    """Four bytes of the page that is written."""

    TYPE: ClassVar = 0x8003
    data: fields.FourBytes


@dataclass(frozen=True, slots=True)
class BootloaderDescription(Message):
    """Sizes of the flash memory."""

    TYPE: ClassVar = 0x8004
    page_size: fields.U16
    first_page: fields.U16
    page_count: fields.U16


@dataclass(frozen=True, slots=True)
class BootloaderPageData(Message):
    """Four bytes of the page that is read."""

    TYPE: ClassVar = 0x8005
    data: fields.FourBytes


@dataclass(frozen=True, slots=True)
class BootloaderAck(Message):
    """End of a request.

    `error`: 0 none, 1 invalid frame size, 2 programming failed at `address`, 3 not in programming.
    """

    TYPE: ClassVar = 0x8006
    error: fields.U16
    address: fields.OptionalU16 = 0


# From a node.


@dataclass(frozen=True, slots=True)
class Description(Message):
    """A node and the number of its variables, local events and native functions, which follow.

    Sizes are in words.
    """

    TYPE: ClassVar = 0x9000
    name: fields.Text
    version: fields.U16
    bytecode_size: fields.U16
    stack_size: fields.U16
    variables_size: fields.U16
    variable_count: fields.U16
    event_count: fields.U16
    native_count: fields.U16


@dataclass(frozen=True, slots=True)
class NamedVariable(Message):
    """The next variable of a description; its address is the sum of the sizes before it."""

    TYPE: ClassVar = 0x9001
    size: fields.U16
    name: fields.Text


@dataclass(frozen=True, slots=True)
class LocalEventDescription(Message):
    """The next local event of a description."""

    TYPE: ClassVar = 0x9002
    name: fields.Text
    description: fields.Text


@dataclass(frozen=True, slots=True)
class NativeFunctionDescription(Message):
    """The next native function of a description; sizes as in `aseba_vm.target.Parameter`."""

    TYPE: ClassVar = 0x9003
    name: fields.Text
    description: fields.Text
    parameters: fields.Parameters


@dataclass(frozen=True, slots=True)
class Disconnected(Message):
    """The node leaves."""

    TYPE: ClassVar = 0x9004


@dataclass(frozen=True, slots=True)
class Variables(Message):
    """Values of the variables from address `start`."""

    TYPE: ClassVar = 0x9005
    start: fields.U16
    values: fields.Words


@dataclass(frozen=True, slots=True)
class ArrayAccessOutOfBounds(Message):
    """A program used an index outside an array. Some nodes leave out size and index."""

    TYPE: ClassVar = 0x9006
    pc: fields.U16
    size: fields.OptionalU16 = 0
    index: fields.OptionalI16 = 0


@dataclass(frozen=True, slots=True)
class DivisionByZero(Message):
    """A program divided by 0."""

    TYPE: ClassVar = 0x9007
    pc: fields.U16


@dataclass(frozen=True, slots=True)
class EventExecutionKilled(Message):
    """A handler was abandoned at `pc`."""

    TYPE: ClassVar = 0x9008
    pc: fields.U16


@dataclass(frozen=True, slots=True)
class NodeSpecificError(Message):
    """A native function or the node rejected something; `text` is the reason."""

    TYPE: ClassVar = 0x9009
    pc: fields.U16
    text: fields.Text


@dataclass(frozen=True, slots=True)
class ExecutionStateChanged(Message):
    """State of the machine. `flags`: 1 event active, 2 step by step, 4 event running."""

    TYPE: ClassVar = 0x900A
    pc: fields.U16
    flags: fields.U16


@dataclass(frozen=True, slots=True)
class BreakpointSetResult(Message):
    """Reply to SetBreakpoint; `success` is 0 or 1."""

    TYPE: ClassVar = 0x900B
    pc: fields.U16
    success: fields.U16


@dataclass(frozen=True, slots=True)
class NodePresent(Message):
    """Reply to ListNodes."""

    TYPE: ClassVar = 0x900C
    version: fields.U16


@dataclass(frozen=True, slots=True)
class DeviceInfo(Message):
    """Data of the device. `kind`: 1 UUID (16 bytes), 2 name (up to 55 bytes), 3 radio (6 bytes)."""

    TYPE: ClassVar = 0x900D
    kind: fields.U8
    data: fields.Bytes8


def printable(name: str) -> str:
    """A name without the characters that cannot be shown: terminals and logs would act on control characters."""
    return "".join(filter(str.isprintable, name)).strip()


def device_name(name: str) -> bytes:
    """A name as data of a device, of an even size.

    The asebaswitch of Aseba 1.6 takes these messages for user messages, which have words, and aborts otherwise.
    """
    data = name.encode()
    return data + b" " * (len(data) % 2)


@dataclass(frozen=True, slots=True)
class ChangedVariables(Message):
    """Ranges of variables (start, values) that changed since the last request."""

    TYPE: ClassVar = 0x900E
    ranges: fields.Ranges


# To nodes.


@dataclass(frozen=True, slots=True)
class GetDescription(Message):
    """Ask all nodes for their descriptions; nodes answer versions up to 4."""

    TYPE: ClassVar = 0xA000
    version: fields.Version


@dataclass(frozen=True, slots=True)
class SetBytecode(Command):
    """Store words of bytecode at address `start`; the node resets its machine."""

    TYPE: ClassVar = 0xA001
    start: fields.U16
    words: fields.Code


@dataclass(frozen=True, slots=True)
class Reset(Command):
    """Reset the machine, prepare the init event and wait."""

    TYPE: ClassVar = 0xA002


@dataclass(frozen=True, slots=True)
class Run(Command):
    """Leave the step-by-step mode."""

    TYPE: ClassVar = 0xA003


@dataclass(frozen=True, slots=True)
class Pause(Command):
    """Enter the step-by-step mode."""

    TYPE: ClassVar = 0xA004


@dataclass(frozen=True, slots=True)
class Step(Command):
    """Execute one instruction."""

    TYPE: ClassVar = 0xA005


@dataclass(frozen=True, slots=True)
class Stop(Command):
    """Abandon the running handler."""

    TYPE: ClassVar = 0xA006


@dataclass(frozen=True, slots=True)
class GetExecutionState(Command):
    """Ask for the state of the machine."""

    TYPE: ClassVar = 0xA007


@dataclass(frozen=True, slots=True)
class SetBreakpoint(Command):
    """Stop before the instruction at `pc`."""

    TYPE: ClassVar = 0xA008
    pc: fields.U16


@dataclass(frozen=True, slots=True)
class ClearBreakpoint(Command):
    """Remove a breakpoint."""

    TYPE: ClassVar = 0xA009
    pc: fields.U16


@dataclass(frozen=True, slots=True)
class ClearAllBreakpoints(Command):
    """Remove all breakpoints."""

    TYPE: ClassVar = 0xA00A


@dataclass(frozen=True, slots=True)
class GetVariables(Command):
    """Ask for `count` words of the variables from address `start`."""

    TYPE: ClassVar = 0xA00B
    start: fields.U16
    count: fields.U16


@dataclass(frozen=True, slots=True)
class SetVariables(Command):
    """Set the variables from address `start`."""

    TYPE: ClassVar = 0xA00C
    start: fields.U16
    values: fields.Words


@dataclass(frozen=True, slots=True)
class WriteBytecode(Command):
    """Write the program to the flash memory."""

    TYPE: ClassVar = 0xA00D


@dataclass(frozen=True, slots=True)
class Reboot(Command):
    """Restart the node."""

    TYPE: ClassVar = 0xA00E


@dataclass(frozen=True, slots=True)
class SuspendToRam(Command):
    """Suspend the node."""

    TYPE: ClassVar = 0xA00F


@dataclass(frozen=True, slots=True)
class GetNodeDescription(Command):
    """Ask one node for its description."""

    TYPE: ClassVar = 0xA010
    version: fields.Version


@dataclass(frozen=True, slots=True)
class ListNodes(Message):
    """Ask all nodes whether they are there."""

    TYPE: ClassVar = 0xA011
    version: fields.Version


@dataclass(frozen=True, slots=True)
class GetDeviceInfo(Command):
    """Ask for data of the device (since version 6)."""

    TYPE: ClassVar = 0xA012
    kind: fields.U16


@dataclass(frozen=True, slots=True)
class SetDeviceInfo(Command):
    """Set data of the device (since version 6)."""

    TYPE: ClassVar = 0xA013
    kind: fields.U16
    data: fields.Bytes16


@dataclass(frozen=True, slots=True)
class GetChangedVariables(Command):
    """Ask for the variables that changed since the last request (since version 7)."""

    TYPE: ClassVar = 0xA014


@dataclass(frozen=True, slots=True)
class GetDescriptionFragment(Command):
    """Ask for a part of the description (since version 8): -1 the header, -2 all, else the index of an item in the
    order of variables, events and native functions."""

    TYPE: ClassVar = 0xA015
    version: fields.U16
    fragment: fields.I16


_CLASSES: dict[int, Any] = {
    kind.TYPE: kind
    for kind in list(globals().values())
    if isinstance(kind, type) and issubclass(kind, Message) and hasattr(kind, "TYPE")
}


@cache
def _layout(number: int) -> tuple[tuple[str, fields.Field], ...]:
    """Name and kind of each field of the payload of a type, in order."""
    kind = _CLASSES[number]
    hints = get_type_hints(kind, include_extras=True)
    return tuple((field.name, hints[field.name].__metadata__[0]) for field in fields_of(kind) if field.name != "source")


def encode(message: Message) -> bytes:
    """The frame of a message, with its header.

    Raises ProtocolError if a value does not fit its field or the payload is above 65535 bytes. Peers accept 516 bytes.
    """
    number, payload = _parts(message)
    if len(payload) > LARGEST_PAYLOAD:
        raise ProtocolError(
            f"{type(message).__name__}: payload of {len(payload)} bytes, expected at most {LARGEST_PAYLOAD}"
        )
    try:
        return _HEADER.pack(len(payload), message.source, number) + payload
    except struct.error as error:
        raise ProtocolError(f"{type(message).__name__}: source {message.source} or type {number}: {error}") from error


def _parts(message: Message) -> tuple[int, bytes]:
    """The type and the payload of a message."""
    if isinstance(message, UserMessage):
        if not 0 <= message.number < FIRST_SYSTEM_TYPE:
            raise ProtocolError(f"UserMessage: number {message.number}, expected 0..{FIRST_SYSTEM_TYPE - 1}")
        return message.number, fields.WORDS.pack(message.words)
    if isinstance(message, UnknownMessage):
        return message.type, message.payload
    kind = type(message)
    if not hasattr(kind, "TYPE"):
        raise TypeError(f"{kind.__name__} has no type of its own; use one of its subclasses")
    try:
        return kind.TYPE, b"".join(field.pack(getattr(message, name)) for name, field in _layout(kind.TYPE))
    except ProtocolError as error:
        raise ProtocolError(f"{kind.__name__}: {error}") from error


def decode(frame: bytes) -> Message:
    """The message of a frame with its header.

    Bytes behind the last field are ignored. Raises ProtocolError if the frame is not as long as its header states, or
    if the payload is shorter than its type requires.
    """
    if len(frame) < HEADER_SIZE:
        raise ProtocolError(f"frame of {len(frame)} bytes, expected at least {HEADER_SIZE}")
    length, source, number = _HEADER.unpack_from(frame)
    payload = frame[HEADER_SIZE:]
    if len(payload) != length:
        raise ProtocolError(f"type 0x{number:04X}: payload of {len(payload)} bytes, expected {length} by its header")
    if number < FIRST_SYSTEM_TYPE:
        return UserMessage(source, number, fields.WORDS.unpack(payload, 0)[0])
    kind = _CLASSES.get(number)
    if kind is None:
        return UnknownMessage(source, number, payload)
    values = []
    offset = 0
    try:
        for _, field in _layout(number):
            value, offset = field.unpack(payload, offset)
            values.append(value)
    except ProtocolError as error:
        raise ProtocolError(f"type 0x{number:04X} ({kind.__name__}): {error}") from error
    message: Message = kind(source, *values)
    return message
