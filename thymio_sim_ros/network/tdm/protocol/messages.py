"""The messages of the Thymio Device Manager: one frozen dataclass for each, its fields in the order of the slots.

Source: docs/spec/aseba-protocol.md section 2.2. A field is the content of its slot; enumerations are integers, because
a client may send others than those of `constants`.
"""

from __future__ import annotations

from dataclasses import dataclass
from uuid import UUID

from thymio_sim_ros.network.tdm.protocol.wire_types import (
    boolean,
    f64,
    i16,
    i32,
    identifier,
    octets,
    string,
    tables,
    u8,
    u16,
    u32,
    u64,
)  # fmt: skip

__all__ = [
    "MESSAGES",
    "AsebaEvent",
    "AsebaNamedVariable",
    "AsebaNativeFunction",
    "AsebaNativeParameter",
    "Breakpoint",
    "CompilationResultFailure",
    "CompilationResultSuccess",
    "CompileAndLoadCodeOnVM",
    "CompileAndSave",
    "ConnectionHandshake",
    "DeviceManagerShutdownRequest",
    "Dongle",
    "DonglePairingRequest",
    "DonglePairingResponse",
    "DonglesChanged",
    "EnablePairingMode",
    "Error",
    "EventDescription",
    "EventsDescriptionsChanged",
    "EventsEmitted",
    "FirmwareUpgradeRequest",
    "FirmwareUpgradeStatus",
    "LockNode",
    "Message",
    "NamedValue",
    "Node",
    "NodeAsebaVMDescription",
    "NodesChanged",
    "Ping",
    "RegisterEvents",
    "RenameNode",
    "RequestCompleted",
    "RequestListOfNodes",
    "RequestNodeAsebaVMDescription",
    "SaveBytecode",
    "ScratchpadUpdate",
    "SendEvents",
    "SetBreakpoints",
    "SetBreakpointsResponse",
    "SetVMExecutionState",
    "SetVariables",
    "UnlockNode",
    "VMExecutionStateChanged",
    "VariablesChanged",
    "WatchNode",
]


class Message:
    """Base of the messages, the members of the root's union."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class Node:
    """A node as clients see it."""

    node_id: UUID | None = identifier()
    group_id: UUID | None = identifier()
    status: int = i32()
    type: int = i32()
    name: str = string()
    capabilities: int = u64()
    fw_version: str = string()
    latest_fw_version: str = string()


@dataclass(frozen=True, slots=True)
class NamedValue:
    """A variable or event by name; `value` is a FlexBuffer (`values`)."""

    name: str = string()
    value: bytes = octets()


@dataclass(frozen=True, slots=True)
class AsebaNamedVariable:
    """A variable of a node; `index` is its address, `size` in words."""

    index: int = u16()
    name: str = string()
    size: int = u32()


@dataclass(frozen=True, slots=True)
class AsebaEvent:
    """A local event of a node."""

    index: int = u16()
    name: str = string()
    description: str = string()


@dataclass(frozen=True, slots=True)
class AsebaNativeParameter:
    """A parameter of a native function. A negative size travels as its two's complement of 32 bits."""

    name: str = string()
    size: int = u32()


@dataclass(frozen=True, slots=True)
class AsebaNativeFunction:
    """A native function of a node."""

    index: int = u16()
    name: str = string()
    description: str = string()
    parameters: tuple[AsebaNativeParameter, ...] = tables(AsebaNativeParameter)


@dataclass(frozen=True, slots=True)
class EventDescription:
    """An event of the table that the nodes of a group share; `fixed_sized` is its number of words."""

    name: str = string()
    fixed_sized: int = u32()
    index: int = u32()


@dataclass(frozen=True, slots=True)
class Breakpoint:
    """A line of a program, from 1."""

    line: int = u32()


@dataclass(frozen=True, slots=True)
class Dongle:
    """A radio dongle."""

    id: UUID | None = identifier()
    node: int = u16()
    network: int = u16()
    channel: int = u8()


@dataclass(frozen=True, slots=True)
class ConnectionHandshake(Message):
    """The first message of both sides."""

    min_protocol_version: int = u32(1)
    protocol_version: int = u32(1)
    max_message_size: int = u32(102400)
    token: bytes = octets()
    localhost_peer: bool = boolean()
    ws_port: int = u16()
    uuid: UUID | None = identifier()
    password: str = string()


@dataclass(frozen=True, slots=True)
class DeviceManagerShutdownRequest(Message):
    """Ends the process of the device manager."""

    request_id: int = u32()


@dataclass(frozen=True, slots=True)
class RequestListOfNodes(Message):
    """Asks for all nodes."""


@dataclass(frozen=True, slots=True)
class RequestNodeAsebaVMDescription(Message):
    """Asks for the description of a node."""

    request_id: int = u32()
    node_id: UUID | None = identifier()


@dataclass(frozen=True, slots=True)
class LockNode(Message):
    """Reserves a node for a client."""

    request_id: int = u32()
    node_id: UUID | None = identifier()


@dataclass(frozen=True, slots=True)
class UnlockNode(Message):
    """Gives a node back."""

    request_id: int = u32()
    node_id: UUID | None = identifier()


@dataclass(frozen=True, slots=True)
class RenameNode(Message):
    """Gives a node another name."""

    request_id: int = u32()
    node_id: UUID | None = identifier()
    new_name: str = string()


@dataclass(frozen=True, slots=True)
class CompileAndLoadCodeOnVM(Message):
    """Compiles a program for a node; loads it with the option of that name."""

    request_id: int = u32()
    node_id: UUID | None = identifier()
    language: int = i32(1)
    program: str = string()
    options: int = u32()


@dataclass(frozen=True, slots=True)
class NodesChanged(Message):
    """Nodes that are new or have changed."""

    nodes: tuple[Node, ...] = tables(Node)


@dataclass(frozen=True, slots=True)
class NodeAsebaVMDescription(Message):
    """The description of a node; sizes in words."""

    request_id: int = u32()
    node_id: UUID | None = identifier()
    bytecode_size: int = u32()
    data_size: int = u32()
    stack_size: int = u32()
    variables: tuple[AsebaNamedVariable, ...] = tables(AsebaNamedVariable)
    events: tuple[AsebaEvent, ...] = tables(AsebaEvent)
    functions: tuple[AsebaNativeFunction, ...] = tables(AsebaNativeFunction)


@dataclass(frozen=True, slots=True)
class RequestCompleted(Message):
    """A request is done."""

    request_id: int = u32()


@dataclass(frozen=True, slots=True)
class Error(Message):
    """A request is rejected."""

    request_id: int = u32()
    error: int = i32()


@dataclass(frozen=True, slots=True)
class CompilationResultFailure(Message):
    """The first error of a program; character, line and column from 0."""

    request_id: int = u32()
    message: str = string()
    character: int = u32()
    line: int = u32()
    column: int = u32()


@dataclass(frozen=True, slots=True)
class CompilationResultSuccess(Message):
    """Memory that a program uses, and all that there is; in words."""

    request_id: int = u32()
    bytecode_size: int = u32()
    total_bytecode_size: int = u32()
    variables_size: int = u32()
    total_variables_size: int = u32()


@dataclass(frozen=True, slots=True)
class WatchNode(Message):
    """Chooses what a client is sent about a node or group."""

    request_id: int = u32()
    node_or_group_id: UUID | None = identifier()
    info_type: int = u32()


@dataclass(frozen=True, slots=True)
class VariablesChanged(Message):
    """Values of variables, sorted by name; the time in ms."""

    node_id: UUID | None = identifier()
    vars: tuple[NamedValue, ...] = tables(NamedValue)
    timestamp: int = u64()


@dataclass(frozen=True, slots=True)
class SetVariables(Message):
    """Writes variables of a node or those that a group shares."""

    request_id: int = u32()
    node_or_group_id: UUID | None = identifier()
    vars: tuple[NamedValue, ...] = tables(NamedValue)


@dataclass(frozen=True, slots=True)
class EventsDescriptionsChanged(Message):
    """The event table of a group."""

    node_or_group_id: UUID | None = identifier()
    events: tuple[EventDescription, ...] = tables(EventDescription)


@dataclass(frozen=True, slots=True)
class RegisterEvents(Message):
    """Replaces the event table of a group."""

    request_id: int = u32()
    node_or_group_id: UUID | None = identifier()
    events: tuple[EventDescription, ...] = tables(EventDescription)


@dataclass(frozen=True, slots=True)
class SendEvents(Message):
    """Sends events of the table to the nodes of a group."""

    request_id: int = u32()
    node_id: UUID | None = identifier()
    events: tuple[NamedValue, ...] = tables(NamedValue)


@dataclass(frozen=True, slots=True)
class EventsEmitted(Message):
    """Events that a node has emitted; the time in ms."""

    node_id: UUID | None = identifier()
    events: tuple[NamedValue, ...] = tables(NamedValue)
    timestamp: int = u64()


@dataclass(frozen=True, slots=True)
class SetBreakpoints(Message):
    """Replaces the breakpoints of a node."""

    request_id: int = u32()
    node_id: UUID | None = identifier()
    breakpoints: tuple[Breakpoint, ...] = tables(Breakpoint)


@dataclass(frozen=True, slots=True)
class SetBreakpointsResponse(Message):
    """The breakpoints that were accepted."""

    request_id: int = u32()
    error: int = i32()
    breakpoints: tuple[Breakpoint, ...] = tables(Breakpoint)


@dataclass(frozen=True, slots=True)
class SetVMExecutionState(Message):
    """A command to the machine of a node."""

    request_id: int = u32()
    node_id: UUID | None = identifier()
    command: int = i16()


@dataclass(frozen=True, slots=True)
class VMExecutionStateChanged(Message):
    """State of the machine of a node; `line` from 1, 0 without one."""

    node_id: UUID | None = identifier()
    state: int = i16()
    line: int = u32()
    error: int = i16()
    error_msg: str = string()


@dataclass(frozen=True, slots=True)
class ScratchpadUpdate(Message):
    """The source text of a node, which the device manager keeps for other clients."""

    request_id: int = u32()
    scratchpad_id: UUID | None = identifier()
    group_id: UUID | None = identifier()
    node_id: UUID | None = identifier()
    language: int = i32(1)
    text: str = string()
    name: str = string()
    deleted: bool = boolean()


@dataclass(frozen=True, slots=True)
class FirmwareUpgradeRequest(Message):
    """Starts an upgrade of the firmware."""

    request_id: int = u32()
    node_id: UUID | None = identifier()


@dataclass(frozen=True, slots=True)
class FirmwareUpgradeStatus(Message):
    """Progress of an upgrade, 0 to 1."""

    request_id: int = u32()
    node_id: UUID | None = identifier()
    progress: float = f64()


@dataclass(frozen=True, slots=True)
class Ping(Message):
    """Says that the connection is alive."""


@dataclass(frozen=True, slots=True)
class EnablePairingMode(Message):
    """Switches the pairing of wireless robots on or off."""

    enable: bool = boolean(default=True)


@dataclass(frozen=True, slots=True)
class DonglesChanged(Message):
    """The radio dongles."""

    dongles: tuple[Dongle, ...] = tables(Dongle)


@dataclass(frozen=True, slots=True)
class DonglePairingRequest(Message):
    """Pairs a robot with a dongle."""

    request_id: int = u32()
    dongle_id: UUID | None = identifier()
    node_id: UUID | None = identifier()
    network: int = u16()
    channel: int = u8()


@dataclass(frozen=True, slots=True)
class DonglePairingResponse(Message):
    """A robot is paired."""

    request_id: int = u32()
    network: int = u16()
    channel: int = u8()


@dataclass(frozen=True, slots=True)
class CompileAndSave(CompileAndLoadCodeOnVM):
    """Compiles a program and stores it in the memory that survives switching off."""


@dataclass(frozen=True, slots=True)
class SaveBytecode(Message):
    """Bytecode as text."""

    request_id: int = u32()
    node_id: UUID | None = identifier()
    program: str = string()


MESSAGES: tuple[type[Message], ...] = (
    ConnectionHandshake,
    DeviceManagerShutdownRequest,
    RequestListOfNodes,
    RequestNodeAsebaVMDescription,
    LockNode,
    UnlockNode,
    RenameNode,
    CompileAndLoadCodeOnVM,
    NodesChanged,
    NodeAsebaVMDescription,
    RequestCompleted,
    Error,
    CompilationResultFailure,
    CompilationResultSuccess,
    WatchNode,
    VariablesChanged,
    SetVariables,
    EventsDescriptionsChanged,
    RegisterEvents,
    SendEvents,
    EventsEmitted,
    SetBreakpoints,
    SetBreakpointsResponse,
    SetVMExecutionState,
    VMExecutionStateChanged,
    ScratchpadUpdate,
    FirmwareUpgradeRequest,
    FirmwareUpgradeStatus,
    Ping,
    EnablePairingMode,
    DonglesChanged,
    DonglePairingRequest,
    DonglePairingResponse,
    CompileAndSave,
    SaveBytecode,
)
"""Classes by the number of their type minus one."""
