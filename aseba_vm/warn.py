"""What compiles and is probably not meant. Warnings never change the bytecode."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from aseba_vm.bytecode import Op, Segment
from aseba_vm.errors import SourcePos
from aseba_vm.messages import wording
from aseba_vm.tree import Block, OnEvent, Return, Sub, Tree, position_of, walk


@dataclass(frozen=True, slots=True)
class CompileWarning:
    """A doubt about a program: a stable identifier, its arguments, the place."""

    kind: str
    arguments: tuple[str, ...]
    pos: SourcePos

    def __str__(self) -> str:
        return wording(self.kind, self.arguments)

    def located(self, name: str) -> str:
        """Return the message after the name of the file and the place, counted from 1."""
        return f"{name}:{self.pos}: warning: {self}"


def find_warnings(tree: Tree, segments: Sequence[Segment]) -> tuple[CompileWarning, ...]:
    """Return the doubts about a program, given its tree as parsed and its code, in order of place."""
    found = [*_unreachable(tree), *_subroutines(tree, segments), *_far_blocks(segments)]
    return tuple(sorted(found, key=lambda warning: (warning.pos.offset, warning.kind)))


def _unreachable(tree: Tree) -> Iterator[CompileWarning]:
    """The first statement after each ``return`` of the same block."""
    for block in walk(tree.body):
        if not isinstance(block, Block):
            continue
        for before, after in zip(block.statements, block.statements[1:], strict=False):
            pos = position_of(after)
            if isinstance(before, Return) and not isinstance(after, OnEvent | Sub) and pos is not None:
                yield CompileWarning("warning-unreachable", (), pos)


def _subroutines(tree: Tree, segments: Sequence[Segment]) -> Iterator[CompileWarning]:
    """Subroutines that nobody calls, or that may run on into the code after them (VM spec, section 7)."""
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
