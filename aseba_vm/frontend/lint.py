"""Warnings: constructs that compile but are probably mistakes. Warnings never change the bytecode."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from aseba_vm.bytecode import Op, Segment
from aseba_vm.errors import SourcePos
from aseba_vm.frontend.syntax_tree import (
    Access,
    Block,
    For,
    If,
    Node,
    OnEvent,
    Return,
    Sub,
    Subscript,
    Tree,
    children,
    position_of,
    walk,
)
from aseba_vm.messages import format_message


@dataclass(frozen=True, slots=True)
class CompileWarning:
    """A warning about a program: a stable identifier, its arguments, the position."""

    kind: str
    arguments: tuple[str, ...]
    pos: SourcePos

    def __str__(self) -> str:
        return format_message(self.kind, self.arguments)

    def located(self, name: str) -> str:
        """The message with the file name and the position (from 1) in front."""
        return f"{name}:{self.pos}: warning: {self}"


def find_warnings(tree: Tree, segments: Sequence[Segment]) -> tuple[CompileWarning, ...]:
    """The warnings about a program in order of position, from its parsed tree and its code."""
    warnings = [*_subroutines(tree, segments), *_far_blocks(segments)]
    for node in walk(tree.body):
        match node:
            case Block():
                warnings += _unreachable(node)
            case If(is_edge=True):
                warnings += _constant_when(node)
            case For():
                warnings += _endless_for(node)
            case Subscript():
                warnings += _vector_index(node)
    return tuple(sorted(warnings, key=lambda warning: (warning.pos.offset, warning.kind)))


def _unreachable(block: Block) -> Iterator[CompileWarning]:
    """Warn about the first statement after a `return` in the same block."""
    for before, after in zip(block.statements, block.statements[1:], strict=False):
        pos = position_of(after)
        if isinstance(before, Return) and not isinstance(after, OnEvent | Sub) and pos is not None:
            yield CompileWarning("warning-unreachable", (), pos)


def _constant_when(node: If) -> Iterator[CompileWarning]:
    """Warn about a `when` without variables, which has no edge (docs/spec/aseba-language.md section 7)."""
    if not any(isinstance(part, Access | Subscript) for part in walk(node.condition)):
        yield CompileWarning("warning-constant-when", (), node.pos)


def _endless_for(loop: For) -> Iterator[CompileWarning]:
    """Warn about a step that jumps over the end of the 16-bit range (docs/spec/aseba-language.md section 7)."""
    start, end = loop.start.value, loop.end.value
    last = start + int((end - start) / loop.step) * loop.step
    if start != end and not -0x8000 <= last + loop.step <= 0x7FFF:
        yield CompileWarning("warning-endless-for", (str(last),), loop.pos)


def _vector_index(node: Subscript) -> Iterator[CompileWarning]:
    """Warn about arrays in an index, of which only the first word counts (docs/spec/aseba-language.md section 6.1)."""
    parts: list[Node] = [node.index]
    while parts:
        part = parts.pop()
        if isinstance(part, Access) and part.last > part.first:
            yield CompileWarning("warning-vector-index", (part.variable.name,), part.pos)
        elif not isinstance(part, Subscript):
            parts += children(part)


def _subroutines(tree: Tree, segments: Sequence[Segment]) -> Iterator[CompileWarning]:
    """Warn about subroutines that are never called, or that may run on into the code after them.

    Source: docs/spec/aseba-bytecode-vm.md section 7.
    """
    called = {code.operand for segment in segments for code in segment.code if code.op is Op.CALL}
    for segment in segments:
        if not segment.is_sub:
            continue
        sub = tree.subs[segment.number]
        if sub.index not in called:
            yield CompileWarning("warning-uncalled-subroutine", (sub.name,), sub.pos)
        if segment.falls_through:
            yield CompileWarning("warning-fall-through", (sub.name,), sub.pos)


def _far_blocks(segments: Sequence[Segment]) -> Iterator[CompileWarning]:
    for segment in segments:
        for pos in segment.far_blocks:
            yield CompileWarning("warning-far-jump", (), pos)
