"""Debugger: execution of a machine by source row. Rows count from 0, as in all data of this package."""

from __future__ import annotations

from dataclasses import dataclass

from aseba_vm.bytecode import EventEntry, SubEntry, instructions
from aseba_vm.frontend.pipeline import Program
from aseba_vm.machine.machine_messages import ExecutionState
from aseba_vm.vm import VirtualMachine

MAX_STEPS = 100_000
"""Default limit of instructions for a step to the next row."""


@dataclass(frozen=True, slots=True)
class Usage:
    """Number of words in use and in total."""

    used: int
    total: int

    @property
    def share(self) -> float:
        """Fraction in use, 0 to 1; 0 if the total is 0."""
        return self.used / self.total if self.total else 0.0


class Debugger:
    """Breakpoints, steps and positions by source row.

    The machine must have this program loaded; it can still be used directly.
    """

    def __init__(self, machine: VirtualMachine, program: Program) -> None:
        """Attach to a machine that has `program` loaded."""
        self.machine = machine
        self.program = program
        start = 2 * len(program.events) + 1
        self._places: dict[int, int] = {}
        for pc, _ in instructions(program.words, start):
            row = program.lines[pc]
            if row is not None:
                self._places.setdefault(row, pc)

    # -- position

    @property
    def row(self) -> int | None:
        """The row about to be executed; None if no event is active or the code has no row."""
        return self.program.row_of(self.machine.pc) if self.machine.is_active else None

    @property
    def segment(self) -> EventEntry | SubEntry | None:
        """The event or subroutine about to be executed; None if no event is active."""
        return self.program.segment_of(self.machine.pc) if self.machine.is_active else None

    # -- memory use

    @property
    def memory_use(self) -> Usage:
        """Words of variable memory in use, including the target's own variables."""
        return Usage(self.program.allocated, self.machine.target.variables_size)

    @property
    def bytecode_use(self) -> Usage:
        """Words of bytecode memory in use."""
        return Usage(len(self.program.words), self.machine.target.bytecode_size)

    @property
    def stack_use(self) -> Usage:
        """Words of stack that the deepest event needs with all its calls, as estimated by the compiler."""
        return Usage(self.program.stack_need, self.machine.target.stack_size)

    # -- breakpoints

    @property
    def breakpoints(self) -> tuple[int, ...]:
        """Rows with a breakpoint, in ascending order."""
        rows = {row for pc in self.machine.breakpoints if (row := self.program.row_of(pc)) is not None}
        return tuple(sorted(rows))

    def set_breakpoint(self, row: int) -> int | None:
        """Set a breakpoint at `row`, or at the next row that has code. A row with a breakpoint keeps it.

        Returns:
            The row of the breakpoint; None if no row has code there, or if all 16 breakpoints are in use.
        """
        found = min((place for place in self._places if place >= row), default=None)
        if found is None or found in self.breakpoints:
            return found
        self.machine.set_breakpoint(self._places[found])
        return found if found in self.breakpoints else None

    def clear_breakpoint(self, row: int) -> None:
        """Remove the breakpoints of a row, if any."""
        for pc in self.machine.breakpoints:
            if self.program.row_of(pc) == row:
                self.machine.clear_breakpoint(pc)

    def clear_breakpoints(self) -> None:
        """Remove all breakpoints."""
        self.machine.clear_breakpoints()

    # -- execution

    def step_row(self, limit: int = MAX_STEPS) -> bool:
        """Execute to the next row (stepping into subroutines) or to the end of the event.

        A fault ends the step too. Breakpoints are ignored. Of the execution states on the way only the last is
        reported.

        Args:
            limit: maximum number of instructions.

        Returns:
            Whether the step ended within the limit.
        """
        machine, first_row = self.machine, self.row
        if not machine.is_step_by_step:
            machine.pause()
        for _ in range(limit):
            if not machine.is_active:
                return True
            machine.step()
            if machine.is_active and machine.outbox and isinstance(machine.outbox[-1], ExecutionState):
                machine.outbox.pop()
            if self.row is not None and self.row != first_row:
                break
        else:
            machine.report_state()
            return not machine.is_active
        machine.report_state()
        return True

    def resume(self, limit: int = 0) -> bool:
        """Continue from the current breakpoint, if any.

        Args:
            limit: maximum number of instructions, 0 for no limit.

        Returns:
            Whether the machine stopped at another breakpoint.
        """
        machine = self.machine
        if machine.is_active and machine.is_step_by_step and machine.pc in machine.breakpoints:
            machine.step()
        if machine.fault is None:
            machine.resume()
            machine.run(limit)
        return machine.is_active and machine.is_step_by_step
