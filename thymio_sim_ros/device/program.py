"""From the text that a user hands over to a program for the Thymio, or an error with its place in that text."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from aseba_vm import AeslError, CompileError, Program, aesl, compile
from thymio_sim_ros.device.layout import target

MAX_CHARACTERS = 1_000_000


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
    if text.lstrip("\ufeff \t\r\n").startswith("<"):
        return _load_aesl(text.lstrip("\ufeff"), name)
    return _compile(name, text.lstrip("\ufeff"), (), (), row=0, column=0)


def _load_aesl(text: str, name: str) -> ThymioProgram:
    try:
        network = aesl.loads(text)
    except AeslError as error:
        raise ProgramError(name, error.line, error.column, error.reason) from error
    node = network.node(target().name)
    if node is None:
        found = ", ".join(f"'{other.name}'" for other in network.nodes) or "none"
        raise ProgramError(name, None, None, f"no program for '{target().name}'; nodes found: {found}")
    return _compile(name, node.code, network.events, network.constants, row=node.row, column=node.col)


def _compile(
    name: str,
    source: str,
    events: Sequence[tuple[str, int]],
    constants: Sequence[tuple[str, int]],
    *,
    row: int,
    column: int,
) -> ThymioProgram:
    """Compile a text that begins at a row and column of its file."""
    try:
        program = compile(source, target(), events=events, constants=constants)
    except CompileError as error:
        if error.pos is None:
            raise ProgramError(name, None, None, str(error)) from error
        shift = column if error.pos.row == 0 else 0
        raise ProgramError(name, row + error.pos.row + 1, max(0, error.pos.col + shift) + 1, str(error)) from error
    return ThymioProgram(name, source, program, tuple(events), tuple(constants), row + 1)
