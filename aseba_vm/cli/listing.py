"""Listing: the bytecode of a program beside its source."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from aseba_vm.bytecode import EventEntry, Op, SubEntry, instructions, line_of_code, table_lines
from aseba_vm.frontend.pipeline import Program
from aseba_vm.target import TargetDescription

_WIDTH = 100


def listing(
    program: Program,
    source: str,
    target: TargetDescription,
    events: Sequence[tuple[str, int]] = (),
    lines: Sequence[int] | None = None,
) -> str:
    """The event table, each segment with its instructions, and the memory use.

    After `|` there are the number and text of the source line, where the code of another line begins. `lines` are
    the numbers of the rows of `source` in their file (from 1).
    """
    rows = source.split("\n")
    numbers = range(1, len(rows) + 1) if lines is None else lines
    names = _Names(program, target, events)
    entries: list[EventEntry | SubEntry] = [*program.events, *program.subs]
    heads = {entry.address: _heading(entry) for entry in entries}
    result = table_lines(program.words)
    shown: int | None = None
    for pc, code in instructions(program.words, 2 * len(program.events) + 1):
        if pc in heads:
            result += ["", heads[pc]]
            shown = None
        line = line_of_code(pc, code)
        name = names.of(code)
        line += f" ({name})" if name else ""
        row = program.lines[pc]
        if row is not None and row != shown and row < len(rows):
            line = f"{line:52} | {numbers[row]:4}  {rows[row].strip()}"[:_WIDTH]
        shown = row
        result.append(line)
    return "\n".join([*result, "", *_use(program, target)])


class _Names:
    """Names of the numbers in instructions."""

    def __init__(self, program: Program, target: TargetDescription, events: Sequence[tuple[str, int]]) -> None:
        self.natives = [native.name for native in target.natives]
        self.events = [name for name, _ in events]
        self.subs = {sub.address: sub.name for sub in program.subs}
        self.words: dict[int, str] = {}
        for name, (address, size) in (target.addresses | program.addresses).items():
            for index in range(size):
                self.words[address + index] = name if size == 1 else f"{name}[{index}]"
            if size > 1:
                self.words[-1 - address] = name

    def of(self, code: Sequence[int]) -> str:
        operand = code[0] & 0xFFF
        match code[0] >> 12:
            case Op.LOAD | Op.STORE:
                return self.words.get(operand, "temporary")
            case Op.LOADX | Op.STOREX:
                return self.words.get(-1 - operand, self.words.get(operand, ""))
            case Op.NATIVE:
                return self.natives[operand] if operand < len(self.natives) else ""
            case Op.EMIT:
                return self.events[operand] if operand < len(self.events) else ""
            case Op.CALL:
                return self.subs.get(operand, "")
        return ""


def _heading(entry: EventEntry | SubEntry) -> str:
    if isinstance(entry, SubEntry):
        return f"sub {entry.name}"
    return f"onevent {entry.name}" if entry.name else "initialization"


def _use(program: Program, target: TargetDescription) -> Iterator[str]:
    yield f"bytecode   {len(program.words):5} of {target.bytecode_size:5} words"
    yield f"variables  {program.allocated:5} of {target.variables_size:5} words"
    yield f"stack      {program.stack_need:5} of {target.stack_size:5} words"
