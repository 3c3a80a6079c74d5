"""From the text of a file to programs for nodes of a network."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from aseba_vm import AeslError, CompileError, aesl, compile
from aseba_vm.aesl.network import with_vpl_events
from aseba_vm.errors import TextError
from aseba_vm.target import TargetDescription
from thymio_sim_ros.access import RefusedError
from thymio_sim_ros.device.programs.program import ThymioProgram, of_node
from thymio_sim_ros.device.programs.program_assignment import RobotId, assign_nodes, note_lines
from thymio_sim_ros.files.block_files import BlocksError, open_program
from thymio_sim_ros.network.http.replies import Definitions

__all__ = ["Compiled", "NodeToLoad", "compile_file"]

NAME = "by HTTP"
"""Name of a program without a file."""


@dataclass(frozen=True, slots=True)
class NodeToLoad:
    """A node that gets a program: its place in the gateway, its description, and the name of its robot (or empty)."""

    key: tuple[int, int]
    number: int
    target: TargetDescription
    robot: str


@dataclass(frozen=True, slots=True)
class Compiled:
    """A program for each node of a request; all share the events and constants of their file."""

    programs: tuple[tuple[NodeToLoad, ThymioProgram], ...]
    definitions: Definitions
    notes: tuple[str, ...] = ()
    """Messages for the user about programs and robots that do not match."""


def compile_file(text: bytes, nodes: Sequence[NodeToLoad]) -> Compiled:
    """Compile an .aesl file, or bare Aseba text, for each node. Raises RefusedError with line and column.

    The programs of the file go to nodes as everywhere else (`assign_nodes`). A node without one gets the empty program.
    """
    try:
        opened = open_program(text)
        file = opened.text
        network = _parse(file)
        shares = assign_nodes(network, [(node.target.name, RobotId(node.robot, node.number)) for node in nodes])
        programs = tuple(
            (node, _compile(file, network, found or aesl.Node(""), node.target))
            for node, (found, _) in zip(nodes, shares, strict=True)
        )
    except BlocksError as error:
        raise RefusedError(400, str(error)) from error
    except (AeslError, TextError) as error:
        raise RefusedError(400, f"line {error.line}, column {error.column}: {error}") from error
    notes = note_lines((node.robot or node.target.name, notes) for node, (_, notes) in zip(nodes, shares, strict=True))
    return Compiled(programs, Definitions(network.events, network.constants), (*opened.notes, *notes))


def _parse(text: str) -> aesl.Network:
    if not text.strip():
        raise RefusedError(400, "the body is empty; expected an .aesl file or the text of a program")
    return with_vpl_events(aesl.loads(text, strict=True) if aesl.is_aesl(text) else aesl.bare(text, ""))


def _compile(text: str, network: aesl.Network, node: aesl.Node, target: TargetDescription) -> ThymioProgram:
    try:
        program = compile(node.code, target, events=network.events, constants=network.constants)
    except CompileError as error:
        if error.pos is None:
            raise RefusedError(400, str(error)) from error
        row, col = node.place(error.pos.offset)
        raise RefusedError(400, f"line {row + 1}, column {col + 1}: {error}") from error
    return of_node(program, node, network, NAME, text)
