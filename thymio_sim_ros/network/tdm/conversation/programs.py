"""Compiles what clients send, for the description of a node.

A compilation takes milliseconds, with an error up to a second, because the compiler looks for what was meant. It is
therefore a value of its own, which the server runs beside its event loop.
"""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass
from uuid import UUID

from aseba_vm import AeslError, CompileError, Program, TargetDescription, aesl, compile
from aseba_vm.aesl.network import with_vpl_events
from thymio_sim_ros.device.programs.foreign import FOREIGN
from thymio_sim_ros.device.programs.program import ThymioProgram, of_node
from thymio_sim_ros.device.programs.program_assignment import RobotId, assign_nodes
from thymio_sim_ros.network.tdm.protocol.constants import Language
from thymio_sim_ros.network.tdm.protocol.messages import CompilationResultFailure

__all__ = ["MOTORS", "Compilation", "Compiled", "LoadableProgram", "motor_stop"]


MOTORS = ("motor.left.target", "motor.right.target")
"""Variables that move a Thymio."""


@dataclass(frozen=True, slots=True)
class LoadableProgram:
    """A compiled program; `lines[row]` is the line, from 1, of the text that the client sent.

    `known` is the same program with its text, by which a simulated robot shows it.
    """

    program: Program
    lines: tuple[int, ...]
    known: ThymioProgram

    def line_of(self, pc: int) -> int:
        """Line of an address of the bytecode; 0 if no line belongs to it."""
        row = self.program.row_of(pc)
        return 0 if row is None else self.lines[row]

    def place_of(self, line: int) -> tuple[int, int] | None:
        """Address and line of the first code at or after a line; None if there is none."""
        if line < self.lines[0]:
            return None
        for row in range(bisect_left(self.lines, line), len(self.lines)):
            addresses = self.program.addresses_of(row)
            if addresses:
                return addresses[0], self.lines[row]
        return None


@dataclass(frozen=True, slots=True)
class Compiled:
    """The programs by node, and the events and constants that a file declares (None: it was no file)."""

    programs: tuple[tuple[UUID, LoadableProgram], ...]
    events: tuple[tuple[str, int], ...] | None = None
    constants: tuple[tuple[str, int], ...] = ()


@dataclass(frozen=True, slots=True)
class Compilation:
    """A text to be compiled for nodes: their ids, names and numbers on the network, and descriptions."""

    client: int
    request_id: int
    text: str
    language: int
    nodes: tuple[tuple[UUID, RobotId, TargetDescription], ...]
    events: tuple[tuple[str, int], ...]
    constants: tuple[tuple[str, int], ...]
    is_loaded: bool
    """Whether the programs are loaded afterwards."""

    def run(self) -> Compiled | CompilationResultFailure:
        """Compile; thread-safe."""
        if self.language != Language.AESL:
            programs = []
            for key, robot, target in self.nodes:
                found = self._compiled(self.text, target, self.events, self.constants)
                if isinstance(found, CompilationResultFailure):
                    return found
                programs.append((key, self._loadable(found, target.name, robot.number)))
            return Compiled(tuple(programs))
        return self._run_file()

    def _loadable(self, program: Program, name: str, number: int) -> LoadableProgram:
        """The program of a node, with the events and constants that its text needs in a file."""
        lines = tuple(range(1, self.text.count("\n") + 2))
        node = aesl.Node(name, number, self.text)
        network, text = aesl.Network(self.events, self.constants, nodes=(node,)), self.text
        if self.events or self.constants:
            text = aesl.dumps(network)
            [node] = aesl.loads(text).nodes
        return LoadableProgram(program, lines, of_node(program, node, network, FOREIGN, text))

    def _run_file(self) -> Compiled | CompilationResultFailure:
        try:
            network = with_vpl_events(aesl.loads(self.text, strict=True))
        except AeslError as error:
            return CompilationResultFailure(self.request_id, str(error), 0, error.line - 1, error.column - 1)
        shares = assign_nodes(network, [(target.name, robot) for _, robot, target in self.nodes])
        if all(node is None for node, _ in shares):
            names = ", ".join(sorted({node.name for node in network.nodes}))
            wanted = ", ".join(sorted({target.name for _, _, target in self.nodes}))
            text = f"the file has programs for {names}, expected one for {wanted}"
            return CompilationResultFailure(self.request_id, text)
        programs = []
        for (key, _, target), (assigned, _) in zip(self.nodes, shares, strict=True):
            node = assigned or aesl.Node(target.name)
            found = self._compiled(node.code, target, network.events, network.constants)
            if isinstance(found, CompilationResultFailure):
                row, column = node.place(found.character)
                return CompilationResultFailure(self.request_id, found.message, found.character, row, column)
            lines = tuple(row + 1 for row in node.rows_in_file())
            programs.append((key, LoadableProgram(found, lines, of_node(found, node, network, FOREIGN, self.text))))
        return Compiled(tuple(programs), network.events, network.constants)

    def _compiled(
        self,
        source: str,
        target: TargetDescription,
        events: tuple[tuple[str, int], ...],
        constants: tuple[tuple[str, int], ...],
    ) -> Program | CompilationResultFailure:
        try:
            return compile(source, target, events, constants)
        except CompileError as error:
            text = str(error) if error.hint is None else f"{error} ({error.hint})"
            if error.pos is None:
                return CompilationResultFailure(self.request_id, text)
            return CompilationResultFailure(self.request_id, text, error.pos.offset, error.pos.row, error.pos.col)


def motor_stop(target: TargetDescription) -> LoadableProgram:
    """The program that command "stop" leaves on a node: it stops the wheels, if there are any."""
    present = [name for name in MOTORS if name in target.addresses]
    text = "\n".join(f"{name} = 0" for name in present)
    program, lines = compile(text, target), tuple(range(1, len(present) + 2))
    node = aesl.Node(target.name, code=text)
    return LoadableProgram(program, lines, of_node(program, node, aesl.Network(nodes=(node,)), FOREIGN, text))
