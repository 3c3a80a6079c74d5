"""From the text that a user hands over to a program for the Thymio, or an error with its place in that text."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from aseba_vm import AeslError, CompileError, Program, SourcePos, aesl, compile
from thymio_sim_ros.device.layout import target
from thymio_sim_ros.device.places import place_in_file

MAX_CHARACTERS = 1_000_000
MAX_EVENT_WORDS = 258
"""Words that a message on the Aseba network holds."""

_Place = Callable[[SourcePos], tuple[int, int]]
"""Row and column in the user's text, from 0, of a place in the code."""


class ProgramError(Exception):
    """A program that is refused: file, line and column from 1 (None where there is no place), message."""

    def __init__(self, name: str, line: int | None, column: int | None, message: str) -> None:
        where = f" line {line}, column {column}:" if line is not None else ""
        super().__init__(f"{name}:{where} {message}")
        self.name = name
        self.line = line
        self.column = column
        self.message = message


@dataclass(frozen=True, slots=True)
class ThymioProgram:
    """A compiled program with the definitions it shares with others; `first_line` is that of its text in its file."""

    name: str
    source: str
    program: Program
    events: tuple[tuple[str, int], ...] = ()
    constants: tuple[tuple[str, int], ...] = ()
    first_line: int = 1

    def line_of(self, pc: int) -> int | None:
        """Line in the file, from 1, of an address of the bytecode."""
        row = self.program.row_of(pc)
        return None if row is None else self.first_line + row


def load_program(text: str, name: str) -> ThymioProgram:
    """The program of an .aesl file's text or of bare Aseba text; ProgramError for what is wrong with it."""
    if len(text) > MAX_CHARACTERS:
        raise ProgramError(name, None, None, f"{len(text)} characters found, expected at most {MAX_CHARACTERS}")
    text = text.removeprefix("\ufeff").replace("\r\n", "\n")
    if text.lstrip().startswith("<"):
        return _load_aesl(text, name)
    return _compile(name, text, aesl.Network(), 0, lambda pos: (pos.row, pos.col))


def _load_aesl(text: str, name: str) -> ThymioProgram:
    try:
        network = aesl.loads(text)
    except AeslError as error:
        raise ProgramError(name, error.line, error.column, error.reason) from error
    _check_definitions(name, network)
    node = network.node(target().name)
    if node is None:
        found = ", ".join(f"'{other.name}'" for other in network.nodes) or "none"
        raise ProgramError(name, None, None, f"no program for '{target().name}'; nodes found: {found}")
    return _compile(name, node.code, network, node.row, lambda pos: place_in_file(text, node.row, node.col, pos.offset))


def _check_definitions(name: str, network: aesl.Network) -> None:
    """Every event and constant has a name of its own; an event fits a message."""
    for kind, names in (
        ("event", [event for event, _ in network.events]),
        ("constant", [constant for constant, _ in network.constants]),
    ):
        twice = next((found for index, found in enumerate(names) if found in names[:index]), None)
        if twice is not None:
            raise ProgramError(name, None, None, f"{kind} '{twice}' is defined twice")
        if "" in names:
            raise ProgramError(name, None, None, f"{kind} number {names.index('') + 1} has no name")
    for event, size in network.events:
        if size > MAX_EVENT_WORDS:
            raise ProgramError(name, None, None, f"event '{event}': {size} words, expected at most {MAX_EVENT_WORDS}")


def _compile(name: str, source: str, network: aesl.Network, row: int, place: _Place) -> ThymioProgram:
    """Compile a text that begins at a row of its file."""
    try:
        program = compile(source, target(), events=network.events, constants=network.constants)
    except CompileError as error:
        if error.pos is None:
            raise ProgramError(name, None, None, str(error)) from error
        line, column = place(error.pos)
        raise ProgramError(name, line + 1, column + 1, str(error)) from error
    return ThymioProgram(name, source, program, network.events, network.constants, row + 1)
