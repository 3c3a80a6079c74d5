"""The debugger: a machine seen through the lines of its program. Rows count from 0, as in all data of this package."""

from __future__ import annotations

from dataclasses import dataclass

from aseba_vm.bytecode import EventEntry, SubEntry, instructions
from aseba_vm.frontend.pipeline import Program
from aseba_vm.machine.machine_messages import ExecutionState
from aseba_vm.vm import VirtualMachine

MOST_STEPS = 100_000
"""Instructions after which a step to the next line gives up."""


@dataclass(frozen=True, slots=True)
class Use:
    """Words in use and words there are."""

    used: int
    total: int

    @property
    def share(self) -> float:
        """The part in use, from 0 (also of nothing) to 1."""
        return self.used / self.total if self.total else 0.0


class Debugger:
    """Breakpoints, steps and places of a program by line. The machine holds this program and stays usable directly."""

    def __init__(self, machine: VirtualMachine, program: Program) -> None:
        """Look at a machine that has ``program`` loaded."""
        self.machine = machine
        self.program = program
        start = 2 * len(program.events) + 1
        self._places: dict[int, int] = {}
        for pc, _ in instructions(program.words, start):
            row = program.lines[pc]
            if row is not None:
                self._places.setdefault(row, pc)

    # -- where it is

    @property
    def row(self) -> int | None:
        """The row about to be executed; None if no event is active or the code there belongs to no row."""
        return self.program.row_of(self.machine.pc) if self.machine.is_active else None

    @property
    def segment(self) -> EventEntry | SubEntry | None:
        """The event or subroutine about to be executed; None if no event is active."""
        return self.program.segment_of(self.machine.pc) if self.machine.is_active else None

    # -- what it uses

    @property
    def memory_use(self) -> Use:
        """Words of variable memory, the target's own variables included."""
        return Use(self.program.allocated, self.machine.target.variables_size)

    @property
    def bytecode_use(self) -> Use:
        """Words of bytecode memory."""
        return Use(len(self.program.words), self.machine.target.bytecode_size)

    @property
    def stack_use(self) -> Use:
        """Words of the stack that the deepest event needs by the estimate of the compiler, with all that it calls."""
        return Use(self.program.stack_need, self.machine.target.stack_size)

    # -- breakpoints

    @property
    def breakpoints(self) -> tuple[int, ...]:
        """Rows with a breakpoint, in order."""
        rows = {row for pc in self.machine.breakpoints if (row := self.program.row_of(pc)) is not None}
        return tuple(sorted(rows))

    def set_breakpoint(self, row: int) -> int | None:
        """Stop before ``row``, or before the next row that has code; return that row.

        None if there is no code or no room (16 are allowed). A row that has a breakpoint already keeps it.
        """
        found = min((place for place in self._places if place >= row), default=None)
        if found is None or found in self.breakpoints:
            return found
        self.machine.set_breakpoint(self._places[found])
        return found if found in self.breakpoints else None

    def clear_breakpoint(self, row: int) -> None:
        """Remove the breakpoint of a row, if any."""
        for pc in self.machine.breakpoints:
            if self.program.row_of(pc) == row:
                self.machine.clear_breakpoint(pc)

    def clear_breakpoints(self) -> None:
        """Remove all breakpoints."""
        self.machine.clear_breakpoints()

    # -- going on

    def step_row(self, limit: int = MOST_STEPS) -> bool:
        """Execute up to the next row, into subroutines, or to the end of the event; tell whether it got there.

        A fault ends the step too. Breakpoints are not heeded; of the states on the way only the last is told.
        """
        machine, begun = self.machine, self.row
        if not machine.is_step_by_step:
            machine.pause()
        for _ in range(limit):
            if not machine.is_active:
                return True
            machine.step()
            if machine.is_active and machine.outbox and isinstance(machine.outbox[-1], ExecutionState):
                machine.outbox.pop()
            if self.row is not None and self.row != begun:
                break
        else:
            machine.report_state()
            return not machine.is_active
        machine.report_state()
        return True

    def resume(self, limit: int = 0) -> bool:
        """Run on, off the breakpoint where the machine stands; tell whether it stopped at another one."""
        machine = self.machine
        if machine.is_active and machine.is_step_by_step and machine.pc in machine.breakpoints:
            machine.step()
        if machine.fault is None:
            machine.resume()
            machine.run(limit)
        return machine.is_active and machine.is_step_by_step
