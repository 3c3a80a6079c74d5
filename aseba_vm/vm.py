"""The virtual machine: one state object, one interpreter loop, a budget of instructions.

Source: docs/spec/aseba-bytecode-vm.md section 10.

A program can never make the machine raise: a fault stops it, is appended to `outbox` and kept in `fault`.
`aseba_vm.machine.interpreter` has the loop, `aseba_vm.jit.tiering` the faster translated execution.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, MutableSequence, Sequence

from aseba_vm.frontend.pipeline import Program
from aseba_vm.frontend.symbols import INIT_EVENT
from aseba_vm.jit.program_state import Change
from aseba_vm.jit.tiering import AUTO, Tiering, create_tiering
from aseba_vm.kernel.integers import wrap
from aseba_vm.machine import reference
from aseba_vm.machine.code_memory import CodeMemory
from aseba_vm.machine.costs import NO_COSTS, Costs
from aseba_vm.machine.data_memory import Variables
from aseba_vm.machine.interpreter import interpret
from aseba_vm.machine.machine_messages import (
    BadCode,
    BreakpointSet,
    EventKilled,
    ExecutionState,
    Fault,
    Message,
    VariablesRead,
)
from aseba_vm.machine.native_call import Native
from aseba_vm.machine.native_table import NativeTable
from aseba_vm.machine.natives import NATIVES
from aseba_vm.machine.reference import ACTIVE
from aseba_vm.target import TargetDescription

STEP_BY_STEP = 2
RUNNING = 4

MAX_BREAKPOINTS = 16

_UNLIMITED = 1 << 62


class VirtualMachine:
    """The machine of one node. `variables` are signed words that the node may read and write between runs."""

    def __init__(
        self,
        target: TargetDescription,
        natives: Mapping[str, Native] | None = None,
        node_id: int = 1,
        *,
        on_reset: Callable[[VirtualMachine], None] | None = None,
        kills_long_events: bool = False,
        costs: Costs = NO_COSTS,
        engine: str = AUTO,
    ) -> None:
        """Create an idle machine with empty memories.

        Args:
            target: memory sizes, variables, local events and natives.
            natives: implementations by name; they extend or replace the standard ones. A call of a native without
                implementation pops its arguments and leaves a NativeCalled message.
            node_id: number of the node.
            on_reset: called in each reset, for the node's own part of it.
            kills_long_events: abandon an event that reaches the limit of `run`, as the 2.x fork does, instead of
                continuing it in the next run.
            costs: what natives and events take of the limit and add to `instructions`.
            engine: one of `aseba_vm.jit.tiering.ENGINES`. Engines differ in speed only.
        """
        self.target = target
        self.node_id = node_id
        self.costs = costs
        self.variables = Variables(target.variables_size)
        self.pc = 0
        self.sp = -1
        self.flags = 0
        self.outbox: list[Message] = []
        self.fault: Fault | None = None
        self.instructions = 0
        self.extra_cost = 0
        """Cost of the native that is being called, until it is added to `instructions`."""
        self.random: MutableSequence[int] = [0]
        """The state of the random number generator, in whatever storage the active engine needs."""
        self.tracer: Callable[[int], None] | None = None
        self.stack: list[int] = [0] * target.stack_size
        self.code = CodeMemory(target.bytecode_size)
        self._breakpoints: list[int] = []
        self._on_reset = on_reset
        self._kills_long_events = kills_long_events
        self.natives = NativeTable(self, target.natives, {**NATIVES, **(natives or {})}, costs)
        sizes = [variable.size for variable in target.variables[:3]]
        self._source_address = sizes[1] if len(sizes) > 1 else target.variables_size
        self._arguments_size = sizes[2] if len(sizes) > 2 else 0
        self._tiering: Tiering | None = None
        self.use_engine(engine)

    # -- state

    @property
    def bytecode(self) -> tuple[int, ...]:
        """The bytecode memory, unsigned words."""
        return self.code.words

    @property
    def random_state(self) -> int:
        """The state of the random number generator, 16 bits."""
        return self.random[0]

    @random_state.setter
    def random_state(self, value: int) -> None:
        self.random[0] = value & 0xFFFF

    @property
    def is_active(self) -> bool:
        """Whether an event is being executed."""
        return bool(self.flags & ACTIVE)

    @property
    def is_step_by_step(self) -> bool:
        """Whether the machine is paused until `step` or `resume`."""
        return bool(self.flags & STEP_BY_STEP)

    @property
    def breakpoints(self) -> tuple[int, ...]:
        """Addresses of the breakpoints in the order in which they were set."""
        return tuple(self._breakpoints)

    def pop_messages(self) -> tuple[Message, ...]:
        """The messages since the last call, in order. The outbox is empty afterwards."""
        messages = tuple(self.outbox)
        self.outbox.clear()
        return messages

    # -- commands (docs/spec/aseba-bytecode-vm.md section 10.4)

    def set_bytecode(self, words: Sequence[int], start: int = 0) -> None:
        """Write words and reset. Raises ValueError if they do not fit into the memory."""
        if start < 0 or start + len(words) > len(self.code):
            raise ValueError(f"{len(words)} words at {start} do not fit a bytecode memory of {len(self.code)}")
        self.code.write(start, words)
        self.reset()

    def load(self, program: Program) -> None:
        """Write a compiled program and resume: the next `run` executes its initialization.

        Raises ValueError if the program does not fit into the memory.
        """
        self.set_bytecode(program.words)
        self.resume()

    def reset(self) -> None:
        """Stop, clear the state of `when` conditions, and start the initialization, paused.

        The conditions are cleared as far as the reference clears them (`CodeMemory.clear_edges`).
        """
        self.flags = STEP_BY_STEP
        self.fault = None
        self.code.clear_edges()
        if self._tiering is not None:
            self._tiering.apply(Change.WRITTEN)
        if self._on_reset is not None:
            self._on_reset(self)
        if not self.setup(INIT_EVENT):
            self.report_state()

    def resume(self) -> None:
        """Leave the paused state and clear the fault (the *run* command)."""
        self.flags &= ~STEP_BY_STEP
        self.fault = None
        self.report_state()

    def pause(self) -> None:
        """Execute nothing until `step` or `resume`."""
        self.flags |= STEP_BY_STEP
        self.report_state()

    def stop(self) -> None:
        """Abandon the event and pause."""
        self.flags = STEP_BY_STEP
        self.report_state()

    def step(self) -> None:
        """Execute one instruction of the active event."""
        if self.flags & ACTIVE:
            self._trace()
            self._interpret_one()
            self.report_state()

    def report_state(self) -> None:
        """Append an ExecutionState message."""
        self.outbox.append(ExecutionState(self.pc, self.flags))

    def set_breakpoint(self, pc: int) -> None:
        """Add a breakpoint if fewer than MAX_BREAKPOINTS are set, and report whether it was added."""
        if not 0 <= pc < len(self.code):
            self.stop_on(BadCode(pc, "breakpoint-out-of-range"))
            return
        has_room = len(self._breakpoints) < MAX_BREAKPOINTS
        if has_room:
            self._breakpoints.append(pc)
        self.outbox.append(BreakpointSet(pc, has_room))

    def clear_breakpoint(self, pc: int) -> None:
        """Remove the first breakpoint at an address, if any."""
        if pc in self._breakpoints:
            self._breakpoints.remove(pc)

    def clear_breakpoints(self) -> None:
        """Remove all breakpoints."""
        self._breakpoints.clear()

    def report_variables(self, start: int, count: int) -> None:
        """Append a VariablesRead message with a range of the variable memory."""
        self.outbox.append(VariablesRead(start, tuple(self.variables[start : start + count])))

    def write_variables(self, start: int, values: Sequence[int]) -> None:
        """Write words, cut to 16 bits, to the variable memory. Raises ValueError outside the memory."""
        if start < 0 or start + len(values) > len(self.variables):
            raise ValueError(f"{len(values)} words at {start} are outside a memory of {len(self.variables)}")
        self.variables.words[start : start + len(values)] = [wrap(value) for value in values]

    # -- events (docs/spec/aseba-bytecode-vm.md sections 10.2 and 10.5)

    def setup(self, event: int) -> int:
        """Start an event.

        Returns:
            The address of its code; 0 if the program does not handle it.
        """
        address = self.code.addresses.get(event, 0)
        if address == 0:
            return 0
        flags = self.flags
        if flags & ACTIVE:
            self.outbox.append(EventKilled(self.pc))
        self.pc = address
        self.sp = -1
        self.flags = flags | ACTIVE
        if flags & STEP_BY_STEP:
            self.report_state()
        return address

    def receive(self, event: int, source: int, arguments: Sequence[int]) -> None:
        """Start a global event from the network after storing source and arguments; this kills an active event.

        Does nothing while the machine is paused inside an event. Arguments that do not fit are dropped, so this raises
        no error.
        """
        if self.flags & STEP_BY_STEP and self.flags & ACTIVE:
            return
        self._write_source(source, arguments)
        self.setup(event)

    def start_local(self, index: int) -> bool:
        """Start local event `index` of the target. Raises no error.

        Returns:
            False if another event is active; the event was not started then.
        """
        if self.flags & ACTIVE:
            return False
        self._write_source(self.node_id, ())
        self.setup(0xFFFE - index)
        return True

    def _write_source(self, source: int, arguments: Sequence[int]) -> None:
        """Write the source of an event and its arguments, as far as the target has variables for them."""
        memory, address = self.variables.words, self._source_address
        if address < len(memory):
            memory[address] = wrap(source)
        if arguments:
            words = arguments[: min(self._arguments_size, max(len(memory) - address - 1, 0))]
            memory[address + 1 : address + 1 + len(words)] = [wrap(word) for word in words]

    # -- running (docs/spec/aseba-bytecode-vm.md section 10.3)

    def run(self, limit: int = 0) -> bool:
        """Execute the active event.

        Args:
            limit: maximum number of instructions, 0 for no limit. With `costs`, the last operation may exceed it.

        Returns:
            Whether anything was executed.
        """
        if self.flags & (ACTIVE | STEP_BY_STEP) != ACTIVE:
            return False
        self.flags |= RUNNING
        try:
            if self._breakpoints or self.tracer is not None:
                executed, stopped = self._run_watched(limit or _UNLIMITED)
                if stopped:
                    return True
            elif self._tiering is not None:
                executed = self._tiering.run(limit or _UNLIMITED)
            else:
                executed = interpret(self, limit or _UNLIMITED)
        except BaseException:
            self.flags &= ~RUNNING
            raise
        self.flags &= ~RUNNING
        if self._kills_long_events and limit and executed >= limit:
            self.flags &= ~ACTIVE
            self.outbox.append(EventKilled(self.pc))
        return True

    def _run_watched(self, limit: int) -> tuple[int, bool]:
        """Run instruction by instruction, and stop at breakpoints.

        Returns:
            The number of executed instructions, and whether a breakpoint ended the run.
        """
        executed = 0
        running = ACTIVE | RUNNING
        while executed < limit and self.flags & running == running:
            if self.pc in self._breakpoints:
                self.flags |= STEP_BY_STEP
                self.report_state()
                return executed, True
            self._trace()
            executed += self._interpret_one()
        return executed, False

    def _interpret_one(self) -> int:
        """Execute one instruction as the reference does, which may change the bytecode, and return its cost."""
        try:
            return reference.step(self)
        finally:
            if self._tiering is not None:
                self._tiering.apply(Change.WRITTEN)

    def _trace(self) -> None:
        if self.tracer is not None:
            self.tracer(self.pc)

    # -- execution engines (see aseba_vm.jit.tiering)

    def use_engine(self, name: str) -> None:
        """Select how events are executed. Raises ValueError for a name that is not in `ENGINES`."""
        if self._tiering is not None:
            self._tiering.close()
        self._tiering = create_tiering(name, self)

    def charge(self, instructions: int) -> None:
        """Add to the cost of the native that is being called, if costs are enabled."""
        if self.costs is not NO_COSTS:
            self.extra_cost += instructions

    def stop_on(self, fault: Fault) -> None:
        """Stop the event because of a fault and report the fault. Called by the interpreter."""
        self.flags = STEP_BY_STEP
        self.fault = fault
        self.outbox.append(fault)
