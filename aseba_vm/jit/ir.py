"""Intermediate representation of basic blocks: expressions, statements, and the ends of blocks.

A statement is the smallest unit with an effect; `aseba_vm.jit.basic_blocks` states what holds between two of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from aseba_vm.kernel.types import Kernel
from aseba_vm.machine.native_call import Signature


class Const(NamedTuple):
    """A signed word."""

    value: int


class Load(NamedTuple):
    """A word of variable memory."""

    address: int


class Temp(NamedTuple):
    """A value saved while a statement changes memory."""

    number: int


class Index(NamedTuple):
    """An element of an array; bails out if the index is not below the size."""

    base: int
    size: int
    place: Expr


class Unary(NamedTuple):
    """A unary operation; `operator` is its number."""

    operator: int
    operand: Expr


class Binary(NamedTuple):
    """A binary operation; `operator` is its number. Division (5) and remainder (6) bail out if the divisor is 0."""

    operator: int
    left: Expr
    right: Expr


Expr = Const | Load | Temp | Index | Unary | Binary
Atom = Const | Temp


class ProgramPoint(NamedTuple):
    """A point between statements: the address and the words on the stack."""

    pc: int
    pending: tuple[Atom, ...]


class Assign(NamedTuple):
    """Store a value in a word. `keep` is evaluated first; `cost` is in instructions."""

    place: ProgramPoint
    cost: int
    keep: tuple[tuple[Temp, Expr], ...]
    address: int
    value: Expr


class AssignIndex(NamedTuple):
    """Store a value in an array element; bails out if the index is not below the size."""

    place: ProgramPoint
    cost: int
    keep: tuple[tuple[Temp, Expr], ...]
    base: int
    size: int
    element: Expr
    value: Expr


class Emit(NamedTuple):
    """Emit an event with words of memory."""

    place: ProgramPoint
    cost: int
    keep: tuple[tuple[Temp, Expr], ...]
    number: int
    address: int
    length: int


class Call(NamedTuple):
    """Call native `number` with the popped words; `pc` is the address of the instruction."""

    place: ProgramPoint
    cost: int
    keep: tuple[tuple[Temp, Expr], ...]
    number: int
    popped: tuple[Expr, ...]
    pc: int
    after: ProgramPoint


class KnownNative(NamedTuple):
    """The translator's view of a native: `kernel` is its definition if it is a standard native."""

    signature: Signature
    kernel: Kernel | None


Statement = Assign | AssignIndex | Emit | Call


class Branch(NamedTuple):
    """Compare and continue at `then` or `otherwise`; the word at `pc` holds the edge flag."""

    place: ProgramPoint
    cost: int
    pc: int
    operator: int
    left: Expr
    right: Expr
    is_edge: bool
    then: int
    otherwise: int


class Jump(NamedTuple):
    """Continue at `target`. `pc` is the address of the JUMP, or -1 (cost 0) if a block runs into the next one."""

    place: ProgramPoint
    cost: int
    pc: int
    target: int


class EnterSub(NamedTuple):
    """Call the subroutine at `target`, which returns to `back`."""

    place: ProgramPoint
    cost: int
    target: int
    back: int


class Return(NamedTuple):
    """The end of a subroutine."""

    place: ProgramPoint
    cost: int


class Stop(NamedTuple):
    """End the event."""

    place: ProgramPoint
    cost: int


class BailOut(NamedTuple):
    """Continue in the interpreter from here."""

    place: ProgramPoint
    cost: int


End = Branch | Jump | EnterSub | Return | Stop | BailOut


def words_of(popped: Sequence[Expr], signature: Signature) -> int | None:
    """The total number of words of all arguments of a native, None if a size is not constant."""
    total = 0
    for size in signature.sizes:
        length = Const(size) if size > 0 else popped[-size]
        if not isinstance(length, Const):
            return None
        total += length.value & 0xFFFF
    return total


def arguments(popped: Sequence[Expr], signature: Signature) -> list[tuple[int, int]] | None:
    """Address and size of each argument of a native, None if not all are constant."""
    places: list[tuple[int, int]] = []
    for place, size in enumerate(signature.sizes):
        address = popped[place]
        length = Const(size) if size > 0 else popped[-size]
        if not isinstance(address, Const) or not isinstance(length, Const):
            return None
        places.append((address.value & 0xFFFF, length.value & 0xFFFF))
    return places
