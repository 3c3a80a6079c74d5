"""Inputs of the command line: text of a file, the programs in it, and their definitions."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from aseba_vm import aesl
from aseba_vm.aesl.network import select, with_vpl_events
from aseba_vm.aesl.text_decoding import TextFile, decode
from aseba_vm.cli.output import named_errors
from aseba_vm.errors import AeslError, CompileError
from aseba_vm.frontend.pipeline import Stages, compile_stages
from aseba_vm.target import TargetDescription

Definitions = tuple[tuple[str, int], ...]


@dataclass(frozen=True, slots=True)
class Source:
    """A program, its definitions and its file. `is_guessed`: its node is not named after the target."""

    name: str
    node: aesl.Node
    events: Definitions = ()
    constants: Definitions = ()
    is_guessed: bool = False

    def compiled(self, target: TargetDescription) -> Stages:
        """Compile the program. Raises CompileError."""
        return compile_stages(self.node.code, target, self.events, self.constants)

    def stages(self, target: TargetDescription) -> Stages:
        """Compile the program. Raises SourceError, which has the file."""
        try:
            return self.compiled(target)
        except CompileError as error:
            raise SourceError(self, error) from error

    def place(self, offset: int) -> tuple[int, int]:
        """Row and column in the file, from 0."""
        return self.node.place(offset)


class SourceError(Exception):
    """A program with an error, and its source."""

    def __init__(self, source: Source, error: CompileError) -> None:
        super().__init__(source, error)
        self.source = source
        self.error = error


def read_text(name: str) -> TextFile:
    """The text of a file; `-` is the standard input. Raises OSError, TextError."""
    with named_errors(name):
        data = sys.stdin.buffer.read() if name == "-" else Path(name).read_bytes()
    return decode(data)


def network_of(text: str, name: str) -> aesl.Network:
    """The network of a text; a plain program becomes the program of a node called `name`. Raises AeslError."""
    return aesl.loads(text, strict=True) if aesl.is_aesl(text) else aesl.bare(text, name)


def sources_of(
    network: aesl.Network,
    file: str,
    kind: str,
    node: str | None,
    events: Sequence[tuple[str, int]],
    constants: Sequence[tuple[str, int]],
) -> list[Source]:
    """The programs of a file for a kind of device, or those of the nodes called `node`.

    Raises AeslError if there is no such node.
    """
    network = with_vpl_events(network)
    definitions = (*network.events, *events), (*network.constants, *constants)
    selection = select(network, {kind}) if node is None else None
    if selection is not None:
        return [Source(file, program, *definitions, program in selection.guessed) for program in selection.nodes]
    named = [Source(file, program, *definitions) for program in network.nodes if program.name == node]
    if not named:
        row, col = network.nodes[0].place(0)
        names = ", ".join(dict.fromkeys(f"'{program.name}'" for program in network.nodes))
        raise AeslError("aesl-other-robot", (str(node), names), row + 1, col + 1)
    return named
