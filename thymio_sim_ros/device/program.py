"""From the text that a user hands over to a program for the Thymio, or an error with its place in that text."""

from __future__ import annotations

from dataclasses import dataclass

from aseba_vm import AeslError, CompileError, Program, aesl, compile
from thymio_sim_ros.device.layout import THYMIO, target


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
    """A compiled program with the definitions it shares with others; `lines` are those of its rows in its file."""

    name: str
    source: str
    program: Program
    events: tuple[tuple[str, int], ...]
    constants: tuple[tuple[str, int], ...]
    lines: tuple[int, ...]
    layout: str = THYMIO

    def line_of(self, pc: int) -> int | None:
        """Line in the file, from 1, of an address of the bytecode."""
        row = self.program.row_of(pc)
        return None if row is None else self.lines[row]


def load_program(text: str, name: str, layout: str = THYMIO) -> ThymioProgram:
    """The program of an .aesl file's text or of bare Aseba text; ProgramError for what is wrong with it.

    Of a file with several programs for a Thymio the first is taken, and refused if another one is wrong. It is
    compiled for one of `layout.LAYOUTS` and runs on no other.
    """
    text = text.removeprefix("\ufeff").replace("\r\n", "\n")
    try:
        network = aesl.loads(text, strict=True) if aesl.is_aesl(text) else aesl.bare(text, target().name)
    except AeslError as error:
        raise ProgramError(name, error.line, error.column, str(error)) from error
    programs = [_compile(name, node, network, layout) for node in network.nodes if node.name == target().name]
    if not programs:
        line, column = network.nodes[0].place(0)
        found = ", ".join(dict.fromkeys(f"'{node.name}'" for node in network.nodes))
        refusal = AeslError("aesl-other-robot", (target().name, found), line + 1, column + 1)
        raise ProgramError(name, refusal.line, refusal.column, str(refusal))
    return programs[0]


def _compile(name: str, node: aesl.Node, network: aesl.Network, layout: str) -> ThymioProgram:
    try:
        program = compile(node.code, target(layout), events=network.events, constants=network.constants)
    except CompileError as error:
        if error.pos is None:
            raise ProgramError(name, None, None, str(error)) from error
        row, col = node.place(error.pos.offset)
        raise ProgramError(name, row + 1, col + 1, str(error)) from error
    lines = tuple(row + 1 for row in node.rows_in_file())
    return ThymioProgram(name, node.code, program, network.events, network.constants, lines, layout)
