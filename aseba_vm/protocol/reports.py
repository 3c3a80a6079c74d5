"""Reports of an `aseba_vm.protocol.node_client.NodeClient`: events on the network."""

from __future__ import annotations

from dataclasses import dataclass

from aseba_vm.protocol.messages import (
    ArrayAccessOutOfBounds,
    DivisionByZero,
    EventExecutionKilled,
    Message,
    NodeSpecificError,
)

#: Bits of the flags of an execution state.
EVENT_ACTIVE, STEP_BY_STEP, EVENT_RUNNING = 1, 2, 4

FaultMessage = ArrayAccessOutOfBounds | DivisionByZero | EventExecutionKilled | NodeSpecificError


@dataclass(frozen=True, slots=True)
class ExecutionState:
    """Address and flags of a node's machine."""

    pc: int
    flags: int

    @property
    def is_active(self) -> bool:
        """Whether a handler is active; `pc` has a meaning only then."""
        return bool(self.flags & EVENT_ACTIVE)

    @property
    def is_step_by_step(self) -> bool:
        """Whether the machine waits: after a reset, a pause, a fault, or at a breakpoint."""
        return bool(self.flags & STEP_BY_STEP)


@dataclass(frozen=True, slots=True)
class NodeConnected:
    """A node is complete: its description is known. Reported again if the node describes itself otherwise."""

    node: int


@dataclass(frozen=True, slots=True)
class NodeDisconnected:
    """A node that was connected is gone, or starts again; `reason` is for the user."""

    node: int
    reason: str


@dataclass(frozen=True, slots=True)
class NodeUnusable:
    """A node is present, but its description does not arrive or contradicts itself; reported once."""

    node: int
    reason: str


@dataclass(frozen=True, slots=True)
class VariablesRead:
    """Values arrived. `changed` are the names of variables whose values differ from before, in order of address."""

    node: int
    start: int
    values: tuple[int, ...]
    changed: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class EventReceived:
    """A node, or another client (number `source`), has sent an event of programs."""

    source: int
    number: int
    words: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class StateReported:
    """A node has reported the state of its machine."""

    node: int
    state: ExecutionState


@dataclass(frozen=True, slots=True)
class ProgramLoaded:
    """A node has confirmed all parts of the program that was sent last."""

    node: int


@dataclass(frozen=True, slots=True)
class FaultReported:
    """The program of a node has ended a handler because of an error, or the node rejects something."""

    node: int
    message: FaultMessage


@dataclass(frozen=True, slots=True)
class BreakpointReported:
    """Reply to SetBreakpoint."""

    node: int
    pc: int
    is_set: bool


@dataclass(frozen=True, slots=True)
class DeviceInfoReceived:
    """Data of a device, by kind (`aseba_vm.protocol.messages.DeviceInfo`)."""

    node: int
    kind: int
    data: bytes


@dataclass(frozen=True, slots=True)
class RequestTimedOut:
    """A node has not answered in time; `request` is the message, of a program the last part."""

    node: int
    request: Message


Report = (
    NodeConnected
    | NodeDisconnected
    | NodeUnusable
    | VariablesRead
    | EventReceived
    | StateReported
    | ProgramLoaded
    | FaultReported
    | BreakpointReported
    | DeviceInfoReceived
    | RequestTimedOut
)
