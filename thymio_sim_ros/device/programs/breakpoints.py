"""Breakpoints and steps by lines of the file of a program.

Source: docs/aseba_ros.md, "Run control and breakpoints".
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from aseba_vm import Debugger, VirtualMachine
from thymio_sim_ros.device.programs.program import ThymioProgram

__all__ = ["Breakpoints", "LineDebugger"]


@dataclass(frozen=True, slots=True)
class Breakpoints:
    """Lines with a breakpoint, in order; `moved` has each requested line without code and the line used, or None."""

    lines: tuple[int, ...] = ()
    moved: Mapping[int, int | None] = field(default_factory=dict)


class LineDebugger:
    """Controls a machine by lines of the file, which count from 1."""

    def __init__(self, machine: VirtualMachine, program: ThymioProgram) -> None:
        self._machine = machine
        self._program = program

    @cached_property
    def _debugger(self) -> Debugger:
        return Debugger(self._machine, self._program.program)

    def set_breakpoints(self, lines: Sequence[int]) -> Breakpoints:
        """Replace all breakpoints; a line without code is replaced by the next one with code."""
        self._machine.clear_breakpoints()
        found = {line: self._set(line) for line in sorted(set(lines))}
        active = sorted({line for line in found.values() if line is not None})
        return Breakpoints(tuple(active), {line: new for line, new in found.items() if new != line})

    def step_line(self) -> None:
        """Execute up to the next line or the end of the event."""
        self._debugger.step_row()

    def leave_breakpoint(self) -> bool:
        """If the machine is at a breakpoint, execute the instruction there; return whether it was."""
        machine = self._machine
        if not (machine.is_active and machine.is_step_by_step and machine.pc in machine.breakpoints):
            return False
        machine.step()
        return True

    def _set(self, line: int) -> int | None:
        rows = self._program.lines
        if line < rows[0]:  # another part of the file
            return None
        row = bisect_left(rows, line)
        found = self._debugger.set_breakpoint(row) if row < len(rows) else None
        return None if found is None else rows[found]
