"""What blocks of bytecode are made of: expressions, the statements that use them, and the ends of blocks.

A statement is the least that has an effect; see :mod:`aseba_vm.jit.basic_blocks` for what holds between two of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from aseba_vm.machine.native_call import Signature


class Const(NamedTuple):
    """A signed word."""

    value: int


class Load(NamedTuple):
    """A word of variable memory."""

    address: int


class Temp(NamedTuple):
    """A value kept aside while a statement changes memory."""

    number: int


class Index(NamedTuple):
    """A word of an array; leaves if the place is not below the size."""

    base: int
    size: int
    place: Expr


class Unary(NamedTuple):
    """An operator by number over one value."""

    operator: int
    operand: Expr


class Binary(NamedTuple):
    """An operator by number over two values; 5 and 6 leave if the right one is 0."""

    operator: int
    left: Expr
    right: Expr


Expr = Const | Load | Temp | Index | Unary | Binary
Atom = Const | Temp


class ProgramPoint(NamedTuple):
    """A point between statements: address, words on the stack."""

    pc: int
    pending: tuple[Atom, ...]


class Assign(NamedTuple):
    """Store a value, after keeping aside what the stack still holds. ``cost`` is in instructions."""

    place: ProgramPoint
    cost: int
    keep: tuple[tuple[Temp, Expr], ...]
    address: int
    value: Expr


class AssignIndex(NamedTuple):
    """Store a value in an array; leaves if the element is not below the size."""

    place: ProgramPoint
    cost: int
    keep: tuple[tuple[Temp, Expr], ...]
    base: int
    size: int
    element: Expr
    value: Expr


class Emit(NamedTuple):
    """Send an event with words of memory."""

    place: ProgramPoint
    cost: int
    keep: tuple[tuple[Temp, Expr], ...]
    number: int
    address: int
    length: int


class Call(NamedTuple):
    """Call native ``number`` with the words popped; ``pc`` is that of the instruction."""

    place: ProgramPoint
    cost: int
    keep: tuple[tuple[Temp, Expr], ...]
    number: int
    popped: tuple[Expr, ...]
    pc: int
    after: ProgramPoint


class KnownNative(NamedTuple):
    """A native as far as a translator may rely on it.

    ``is_confined``: it touches nothing but its arguments. ``is_standard``: it is the function of
    docs/spec/aseba-bytecode-vm.md section 12.
    """

    signature: Signature
    is_confined: bool
    is_standard: bool


Statement = Assign | AssignIndex | Emit | Call


class Branch(NamedTuple):
    """Compare and go to ``then`` or ``otherwise``; the word at ``pc`` remembers the condition."""

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
    """Go to ``target``; ``pc`` is that of the JUMP, or -1 where a block just runs into the next (cost 0)."""

    place: ProgramPoint
    cost: int
    pc: int
    target: int


class EnterSub(NamedTuple):
    """Call the subroutine at ``target``, which returns to ``back``."""

    place: ProgramPoint
    cost: int
    target: int
    back: int


class Return(NamedTuple):
    """Return from a subroutine."""

    place: ProgramPoint
    cost: int


class Stop(NamedTuple):
    """End the event."""

    place: ProgramPoint
    cost: int


class BailOut(NamedTuple):
    """Let the interpreter go on from here."""

    place: ProgramPoint
    cost: int


End = Branch | Jump | EnterSub | Return | Stop | BailOut


def words_of(popped: Sequence[Expr], signature: Signature) -> int | None:
    """Return the words of all arguments of a native together, or None if a size is not constant."""
    total = 0
    for size in signature.sizes:
        length = Const(size) if size > 0 else popped[-size]
        if not isinstance(length, Const):
            return None
        total += length.value & 0xFFFF
    return total


def arguments(popped: Sequence[Expr], signature: Signature) -> list[tuple[int, int]] | None:
    """Return address and size of each argument of a native, or None if they are not all constant."""
    found: list[tuple[int, int]] = []
    for place, size in enumerate(signature.sizes):
        address = popped[place]
        length = Const(size) if size > 0 else popped[-size]
        if not isinstance(address, Const) or not isinstance(length, Const):
            return None
        found.append((address.value & 0xFFFF, length.value & 0xFFFF))
    return found
