"""A node as the device manager shows it to clients: who has locked it, its program, values, state of its machine."""

from __future__ import annotations

from dataclasses import dataclass, field
from uuid import UUID

from aseba_vm.protocol.messages import (
    ArrayAccessOutOfBounds,
    DivisionByZero,
    EventExecutionKilled,
    NodeSpecificError,
)  # fmt: skip
from aseba_vm.protocol.node_client import NodeClient
from aseba_vm.protocol.remote_node import RemoteNode
from aseba_vm.protocol.reports import ExecutionState, FaultMessage
from thymio_sim_ros.network.tdm.conversation.group import Group
from thymio_sim_ros.network.tdm.conversation.programs import LoadableProgram
from thymio_sim_ros.network.tdm.protocol.constants import NodeType, VMError, VMState
from thymio_sim_ros.network.tdm.protocol.messages import (
    Breakpoint,
    CompilationResultSuccess,
    NamedValue,
    SetBreakpointsResponse,
    VariablesChanged,
    VMExecutionStateChanged,
)  # fmt: skip
from thymio_sim_ros.network.tdm.protocol.values import NO_VALUE, encode_value

__all__ = ["ManagedNode", "PendingBreakpoints", "PendingLoad"]

_FIRMWARE = "_fwversion"
"""Variable with version and variant of the firmware."""


MAX_LINE_STEPS = 1000
"""Instructions that a step to the next line may take."""


@dataclass(slots=True)
class PendingLoad:
    """A request to load programs: its answer, and the nodes that have not confirmed yet."""

    client: int
    answer: CompilationResultSuccess
    waiting: set[UUID]


@dataclass(slots=True)
class PendingBreakpoints:
    """A request for breakpoints: addresses without a reply yet with their lines, and the lines that are set."""

    client: int
    request_id: int
    sent_ns: int
    waiting: dict[int, int]
    lines: set[int] = field(default_factory=set)

    def answer(self) -> SetBreakpointsResponse:
        """The lines that are set."""
        return SetBreakpointsResponse(self.request_id, 0, tuple(Breakpoint(line) for line in sorted(self.lines)))


class ManagedNode:
    """One node. `locker` is the client that has locked it."""

    def __init__(
        self, key: UUID, group: Group, network: int, link: NodeClient, remote: RemoteNode, *, kind: NodeType, name: str
    ) -> None:
        self.id = key
        self.group = group
        self.network = network
        """Number of its network."""
        self.link = link
        """The client of its network."""
        self.remote = remote
        """The node as it is known from the network."""
        self.kind = kind
        self.name = name
        self.locker: int | None = None
        self.program: LoadableProgram | None = None
        """The program that was loaded here; None: another one."""
        self.vm = VMExecutionStateChanged(key, VMState.STOPPED)
        """State of its machine as last sent to clients."""
        self.idle_state = VMState.STOPPED
        """The state that is reported for a machine without an active event: paused after a pause or step."""
        self.loads: list[PendingLoad] = []
        """Requests that are answered when the node has confirmed its program."""
        self.breakpoints: PendingBreakpoints | None = None
        """The request for breakpoints that is not answered yet."""
        self.has_breakpoints = False
        """Whether breakpoints have been set since they were cleared."""
        self.announced_firmware = ""
        """The version that clients know."""
        self._line_step: tuple[int, int] | None = None
        """The line that a step to the next line leaves, and how many instructions it may still take."""
        self.waiting_for_values: list[tuple[int, int]] = []
        """Clients and requests that are sent all variables when they have been read."""
        self._published: dict[str, tuple[int, ...]] = {}

    @property
    def number(self) -> int:
        """Its number on the network."""
        return self.remote.number

    @property
    def firmware(self) -> str:
        """Version of the firmware; empty while it is not known."""
        if _FIRMWARE not in self.remote.addresses:
            return ""
        words = self.remote.value(_FIRMWARE)
        return str(words[0]) if words else ""

    def read_firmware(self) -> None:
        """Request the version of the firmware."""
        if _FIRMWARE in self.remote.addresses:
            self.link.read(self.number, [_FIRMWARE])

    def load(self, program: LoadableProgram) -> None:
        """Load a program; it waits for command "run"."""
        self.program = program
        self._line_step = None
        self.idle_state = VMState.STOPPED
        self.link.load(self.number, program.program)

    def begin_line_step(self) -> None:
        """Continue steps until the line changes."""
        state = self.remote.state
        self._line_step = (self.line_of(state.pc) if state and state.is_active else 0, MAX_LINE_STEPS)

    def continues_line_step(self, state: ExecutionState) -> bool:
        """Whether a step to the next line needs one more instruction after the one that led to this state."""
        if self._line_step is None:
            return False
        line, left = self._line_step
        is_inside = state.is_active and state.is_step_by_step and self.line_of(state.pc) in (line, 0)
        self._line_step = (line, left - 1) if is_inside and left else None
        return self._line_step is not None

    def request_values(self) -> None:
        """Request all variables, unless they are on their way."""
        if not self.remote.is_reading:
            self.link.read(self.number)

    def pop_changes(self, time_ms: int) -> VariablesChanged | None:
        """The variables that differ from those that were published last; null for those that are gone."""
        values = self.remote.values()
        changed = {name: encode_value(words) for name, words in values.items() if self._published.get(name) != words}
        gone = (name for name in self._published if name not in self.remote.addresses)
        changed |= dict.fromkeys(gone, NO_VALUE)
        self._published = values
        return self._variables(changed, time_ms) if changed else None

    def all_variables(self, time_ms: int) -> VariablesChanged:
        """All variables that have been read."""
        return self._variables({name: encode_value(words) for name, words in self._published.items()}, time_ms)

    def state_message(self, state: ExecutionState) -> VMExecutionStateChanged:
        """A state of its machine for clients. The error of a fault stays until the machine runs again."""
        if not state.is_step_by_step:
            return VMExecutionStateChanged(self.id, VMState.RUNNING)
        if state.is_active:
            return VMExecutionStateChanged(self.id, VMState.PAUSED, self.line_of(state.pc))
        if self.vm.error != VMError.NONE and self.vm.state != VMState.RUNNING:
            return self.vm
        return VMExecutionStateChanged(self.id, self.idle_state)

    def fault_message(self, fault: FaultMessage) -> VMExecutionStateChanged:
        """An error of its program for clients."""
        line = self.line_of(fault.pc)
        match fault:
            case EventExecutionKilled():
                text = "a handler was ended by another event"
                return VMExecutionStateChanged(self.id, self.vm.state, line, VMError.KILLED, text)
            case ArrayAccessOutOfBounds(size=size, index=index):
                text = f"index {index} of an array of {size} words"
                return VMExecutionStateChanged(self.id, VMState.STOPPED, line, VMError.OUT_OF_BOUNDS, text)
            case DivisionByZero():
                text = "division by zero"
                return VMExecutionStateChanged(self.id, VMState.STOPPED, line, VMError.DIVISION_BY_ZERO, text)
            case NodeSpecificError(text=text):
                return VMExecutionStateChanged(self.id, VMState.STOPPED, line, VMError.GENERIC, text)

    def line_of(self, pc: int) -> int:
        """Line of an address, from 1; 0 if it is not known."""
        return 0 if self.program is None else self.program.line_of(pc)

    def _variables(self, values: dict[str, bytes], time_ms: int) -> VariablesChanged:
        return VariablesChanged(self.id, tuple(NamedValue(name, values[name]) for name in sorted(values)), time_ms)
