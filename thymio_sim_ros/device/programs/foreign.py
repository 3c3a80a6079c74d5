"""Programs that reach a robot as bytecode, from another program on its network."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from aseba_vm import EventEntry, Program
from aseba_vm.bytecode import Op, instructions
from aseba_vm.cli.listing import listing
from thymio_sim_ros.device.layout import THYMIO, target
from thymio_sim_ros.device.programs.program import ThymioProgram

__all__ = ["FOREIGN", "MAX_EVENTS", "foreign_program", "is_unnamed"]

FOREIGN = "from the network"
"""Name of a program without a file."""

MAX_EVENTS = 40
"""Events with a name, since each has topics; the highest number decides. Events beyond them stay on the network."""

_INIT, _FIRST_LOCAL = 0xFFFF, 0x8000
_MAX_ARGUMENTS = 32
"""Words of `event.args`: the size of an event that the program receives only."""


def foreign_program(
    words: Sequence[int], layout: str = THYMIO, events: Sequence[tuple[str, int]] = ()
) -> ThymioProgram:
    """Return the program of any words of bytecode; its text is their disassembly.

    Its variables have no names. Event n has the name n of `events`, else `event_n`.
    """
    words = tuple(words)
    described = target(layout)
    table = [(words[at], words[at + 1]) for at in range(1, min(words[0], len(words)) - 1, 2)] if words else []
    named = (*events, *_further_events(words, table, len(events)))
    local = [event.name for event in described.local_events]
    entries = tuple(EventEntry(number, address, _name(number, named, local)) for number, address in table)
    program = Program(words, (None,) * len(words), (), entries, (), described.variables_end, (), 0)
    text = listing(program, "", described, named) if words else ""
    rows = text.split("\n")
    row_of = {int(line[:5]): row for row, line in enumerate(rows) if line[:5].strip().isdecimal()}
    lines: list[int | None] = [row_of.get(pc) for pc in range(len(words))]
    for pc, code in instructions(words, 2 * len(table) + 1):
        lines[pc : pc + len(code)] = [row_of.get(pc)] * len(code)
    return ThymioProgram(
        FOREIGN,
        text,
        replace(program, lines=tuple(lines)),
        named,
        (),
        tuple(range(1, len(rows) + 1)),
        layout,
        text=text,
        is_foreign=True,
    )


def is_unnamed(program: ThymioProgram, event: str) -> bool:
    """Whether the event of a program has only a number, which has another meaning in other programs."""
    made_up = (f"event_{number}" for number, (name, _) in enumerate(program.events) if name == event)
    return program.is_foreign and event in made_up


def _further_events(words: Sequence[int], table: Sequence[tuple[int, int]], known: int) -> list[tuple[str, int]]:
    """Return name and size of the events that the program handles or emits, from the number `known` on."""
    sizes = {number: _MAX_ARGUMENTS for number, _ in table if number < _FIRST_LOCAL}
    for _, code in instructions(words, 2 * len(table) + 1):
        if code[0] >> 12 == Op.EMIT and len(code) == 3:
            sizes[code[0] & 0xFFF] = code[2]
    end = max((number for number in sizes if number < MAX_EVENTS), default=-1) + 1
    return [(f"event_{number}", sizes.get(number, 0)) for number in range(known, end)]


def _name(number: int, events: Sequence[tuple[str, int]], local: Sequence[str]) -> str:
    """Return the name of an event of the table, as `EventEntry` has it."""
    if number == _INIT:
        return ""
    if number >= _FIRST_LOCAL:
        index = _INIT - 1 - number
        return local[index] if index < len(local) else f"local_event_{index}"
    return events[number][0] if number < len(events) else f"event_{number}"
