"""Compiles the text of a user to programs for Thymios; errors have a position in that text."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

from aseba_vm import AeslError, CompileError, Program, aesl, compile
from aseba_vm.aesl.network import Selection, is_other_device, with_vpl_events
from aseba_vm.aesl.network import select as select_nodes
from aseba_vm.messages import MESSAGES, format_message
from thymio_sim_ros.device.layout import THYMIO, target
from thymio_sim_ros.errors import ThymioSimError

__all__ = [
    "NO_CONSTANTS",
    "ProgramError",
    "ThymioFile",
    "ThymioProgram",
    "is_skipped",
    "load_file",
    "load_node",
    "load_program",
    "memory_use",
    "of_node",
    "other_device_note",
    "parse",
    "place_of",
    "select",
]

NO_CONSTANTS: Mapping[str, int] = MappingProxyType({})


class ProgramError(ThymioSimError):
    """A program that is rejected: file, line and column from 1 (None without a position), message."""

    def __init__(self, name: str, line: int | None, column: int | None, message: str) -> None:
        where = f" line {line}, column {column}:" if line is not None else ""
        super().__init__(f"{name}:{where} {message}")
        self.name = name
        self.line = line
        self.column = column
        self.message = message


@dataclass(frozen=True, slots=True)
class ThymioProgram:
    """A compiled program for one layout, with the events and constants that all programs of its file share.

    `source` is the text of the program, `text` the whole file, and `lines[row]` the line in the file, from 1, of a row
    of the source. `node` is the part of the file with the program; that of bare text has no name.
    `is_foreign`: it came as bytecode, and its text is the disassembly (`foreign.py`).
    """

    name: str
    source: str
    program: Program
    events: tuple[tuple[str, int], ...]
    constants: tuple[tuple[str, int], ...]
    lines: tuple[int, ...]
    layout: str = THYMIO
    node: aesl.Node = field(default=aesl.Node(""), compare=False)
    text: str = field(default="", compare=False)
    is_foreign: bool = False

    def line_of(self, pc: int) -> int | None:
        """Line in the file, from 1, of an address of the bytecode; None if no line belongs to it."""
        row = self.program.row_of(pc)
        return None if row is None else self.lines[row]


@dataclass(frozen=True, slots=True)
class ThymioFile:
    """The programs of a file, at least one, those of named nodes first; `others` are names of nodes for other devices.

    `notes` are messages about nodes that are skipped for another reason.
    """

    programs: tuple[ThymioProgram, ...]
    others: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


def load_program(text: str, name: str, layout: str = THYMIO) -> ThymioProgram:
    """Compile the text of an .aesl file, or bare Aseba text, for one of `layout.LAYOUTS`.

    Returns the first program of a file with several. Raises ProgramError if a program of the file has an error.
    """
    return load_file(text, name, layout).programs[0]


def load_file(
    text: str,
    name: str,
    layout: str = THYMIO,
    *,
    constants: Mapping[str, int] = NO_CONSTANTS,
    robots: Collection[str] = (),
) -> ThymioFile:
    """Compile all programs of a text for Thymios or for robots of these names.

    A node with an unknown name counts as one for a Thymio; if it does not compile while the file has nodes named after
    a robot, it is skipped with a note. `constants` replace those of the file or are added to them. Raises ProgramError
    if another program has an error.
    """
    try:
        network = parse(text, constants)
    except AeslError as error:
        raise ProgramError(name, error.line, error.column, str(error)) from error
    selection = select(network, robots)
    is_one = len(selection.nodes) == 1
    programs, notes = [], []
    for node in selection.nodes:
        try:
            programs.append(_compile(name, text, node, network, layout, is_one=is_one))
        except ProgramError as error:
            if not is_skipped(node, selection):
                raise
            notes.append(format_message("note-left-out-node", (node.name, str(error))))
    others = tuple(dict.fromkeys(node.name for node in selection.others))
    return ThymioFile(tuple(programs), others, tuple(notes))


def load_node(
    text: str, name: str, place: int, layout: str = THYMIO, *, constants: Mapping[str, int] = NO_CONSTANTS
) -> ThymioProgram:
    """Compile one node of a text, by its place in the file. Raises IndexError, AeslError or ProgramError."""
    network = parse(text, constants)
    return _compile(name, text, network.nodes[place], network, layout, is_one=True)


def place_of(program: ThymioProgram) -> int:
    """Place of the node of a program in its file, for `load_node`."""
    nodes = parse(program.text).nodes
    return next(at for at, node in enumerate(nodes) if (node.name, node.code) == (program.node.name, program.source))


def of_node(
    program: Program, node: aesl.Node, network: aesl.Network, name: str, text: str, layout: str = THYMIO
) -> ThymioProgram:
    """Return the compiled program of a node of a file with this name and text."""
    lines, shown = tuple(row + 1 for row in node.rows_in_file()), replace(node, plugins=())
    return ThymioProgram(name, node.code, program, network.events, network.constants, lines, layout, shown, text)


def parse(text: str, constants: Mapping[str, int] = NO_CONSTANTS) -> aesl.Network:
    """Parse an .aesl file, or bare text as a node without a name; add the events of VPL. Raises AeslError."""
    text = text.removeprefix("\ufeff").replace("\r\n", "\n")
    network = aesl.loads(text, strict=True) if aesl.is_aesl(text) else aesl.bare(text, "")
    network = with_vpl_events(network)
    return replace(network, constants=tuple({**dict(network.constants), **constants}.items()))


def select(network: aesl.Network, robots: Collection[str] = ()) -> Selection:
    """Select the nodes for Thymios or for robots of these names."""
    return select_nodes(network, {"", target().name, *robots})


def is_skipped(node: aesl.Node, selection: Selection) -> bool:
    """Whether a file is accepted without this node if it does not compile."""
    return bool(selection.named) and node in selection.guessed


def other_device_note(node: aesl.Node, messages: Mapping[str, str] = MESSAGES) -> str:
    """Addition to the error of a node that is named after another kind of device; empty for other nodes."""
    return f"; {format_message('note-made-for', (node.name,), messages)}" if is_other_device(node) else ""


def memory_use(program: Program, layout: str = THYMIO) -> dict[str, tuple[int, int]]:
    """Words in use and in total of variables, bytecode and stack (an estimate for the deepest event)."""
    memory = target(layout)
    return {
        "variables": (program.allocated, memory.variables_size),
        "bytecode": (len(program.words), memory.bytecode_size),
        "stack": (program.stack_need, memory.stack_size),
    }


def node_label(node: aesl.Node) -> str:
    """Text for a node in messages."""
    return f"node '{node.name}' {node.node_id}" if node.node_id else f"node '{node.name}'"


def _compile(
    name: str, text: str, node: aesl.Node, network: aesl.Network, layout: str, *, is_one: bool
) -> ThymioProgram:
    try:
        program = compile(node.code, target(layout), events=network.events, constants=network.constants)
    except CompileError as error:
        message = (str(error) if is_one else f"{node_label(node)}: {error}") + other_device_note(node)
        if error.hint is not None:
            message += f" ({error.hint.message(rows=node.rows_in_file())})"
        if error.pos is None:
            raise ProgramError(name, None, None, message) from error
        row, col = node.place(error.pos.offset)
        raise ProgramError(name, row + 1, col + 1, message) from error
    return of_node(program, node, network, name, text, layout)
