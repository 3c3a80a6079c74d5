"""How a translated function uses words of memory, and which of them it may keep in local variables.

A word may be a local variable if the function accesses it only by its constant address. Then no array access, event or
native can read or write it behind the back of the local variable; natives that may access any word are barriers.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from aseba_vm.jit.ir import (
    Assign,
    AssignIndex,
    Binary,
    Branch,
    Call,
    Const,
    Emit,
    Expr,
    Index,
    KnownNative,
    Load,
    Statement,
    Temp,
    Unary,
    arguments,
)
from aseba_vm.jit.structured_ir import If, Loop, Node

MAX_SCALAR_EMIT = 8
"""Maximum number of words of an event that are read one by one instead of as a slice."""


class MemoryUsage:
    """The words and branches that a function uses.

    ``scalars`` are accessed by a constant address, ``stored`` are the scalars that are written, ``shared`` belong to an
    array or an argument of a native and must stay in memory.
    """

    def __init__(self, natives: Sequence[KnownNative]) -> None:
        self.natives = natives
        self.scalars: set[int] = set()
        self.stored: set[int] = set()
        self.shared: set[int] = set()
        self.branches: set[int] = set()

    def visit(self, nodes: Iterable[Node]) -> None:
        """Add the nodes and everything inside them."""
        for node in nodes:
            match node:
                case If(branch, then, otherwise):
                    self._branch(branch)
                    self.visit(then)
                    self.visit(otherwise)
                case Loop(_, before, branch, body):
                    self._branch(branch)
                    self.visit(before)
                    self.visit(body)
                case Assign() | AssignIndex() | Emit() | Call():
                    self._statement(node)

    def _branch(self, branch: Branch) -> None:
        self.branches.add(branch.pc)
        self._expressions(branch.left, branch.right)

    def _statement(self, node: Statement) -> None:
        self._expressions(*(expression for _, expression in node.keep))
        match node:
            case Assign(address=address, value=value):
                self.scalars.add(address)
                self.stored.add(address)
                self._expressions(value)
            case AssignIndex(base=base, size=size, element=index, value=value):
                self.shared.update(range(base, base + size))
                self._expressions(index, value)
            case Emit(address=address, length=count):
                words = range(address, address + count)
                (self.scalars if count <= MAX_SCALAR_EMIT else self.shared).update(words)
            case Call(popped=popped):
                self._expressions(*popped)
                if not needs_barrier(node, self.natives):
                    for address, size in arguments(node.popped, self.natives[node.number].signature) or ():
                        self.shared.update(range(address, address + size))

    def _expressions(self, *waiting: Expr) -> None:
        stack = list(waiting)
        while stack:
            match stack.pop():
                case Load(address):
                    self.scalars.add(address)
                case Index(base, size, index):
                    self.shared.update(range(base, base + size))
                    stack.append(index)
                case Unary(_, operand):
                    stack.append(operand)
                case Binary(_, left, right):
                    stack += (left, right)
                case Const() | Temp():
                    pass


def needs_barrier(node: Call, natives: Sequence[KnownNative]) -> bool:
    """Return whether a native may access memory other than arguments with a constant address and size."""
    native = natives[node.number]
    return not native.is_confined or arguments(node.popped, native.signature) is None


def contiguous_ranges(places: Iterable[int]) -> list[tuple[int, int]]:
    """Return the first and last address of each contiguous range, in ascending order."""
    found: list[tuple[int, int]] = []
    for place in sorted(places):
        if found and found[-1][1] == place - 1:
            found[-1] = (found[-1][0], place)
        else:
            found.append((place, place))
    return found
