"""Expressions as vectors: size, address, scalar elements.

Source: docs/spec/aseba-language.md sections 6 and 11.

The parser (sizes of arguments, constants), the size check and lowering use this module. An element that does not exist
is represented by `MissingElement` until a scalar assignment needs it, which preserves the order of errors.
"""

from __future__ import annotations

from dataclasses import dataclass

from aseba_vm.errors import CompileError, SourcePos
from aseba_vm.frontend.syntax_tree import Access, Binary, Element, Expression, ListLiteral, Subscript, Unary, Word
from aseba_vm.frontend.trampoline import Task, run


@dataclass(frozen=True, slots=True)
class MissingElement:
    """Placeholder for an element that does not exist, with the error to raise when it is needed."""

    error: CompileError


Scalar = Expression | MissingElement


def size_of(expression: Expression) -> int:
    """The number of words. Raises CompileError for operands of different sizes and for an invalid slice end."""
    return run(_size(expression))


def _size(expression: Expression) -> Task[int]:
    match expression:
        case Access(variable, first, last, pos, is_slice):
            if is_slice and not 0 <= last < variable.size:
                raise CompileError("index-out-of-bounds", (variable.name, last, variable.size), pos)
            return last - first + 1
        case Subscript(_, ListLiteral(items), _, pos):
            total = 0
            for item in items:
                total += yield _size(item)
            raise CompileError("illegal-index" if total > 2 else "list-as-index", (), pos)
        case Unary(_, operand, _):
            size: int = yield _size(operand)
            return size
        case Binary(_, left, right, pos):
            size = yield _size(left)
            other: int = yield _size(right)
            if size != other:
                raise CompileError("size-mismatch", (size, other), pos)
            return size
        case ListLiteral(items):
            size = 0
            for item in items:
                size += yield _size(item)
            return size
    return 1


def check_address(expression: Expression) -> None:
    """Check the start of the leftmost part, as taking its address does. Raises CompileError."""
    while True:
        match expression:
            case Unary(_, operand, _):
                expression = operand
            case Binary(_, left, _, _):
                expression = left
            case ListLiteral(items):
                expression = items[0]
            case Access():
                missing = out_of_bounds(expression)
                if missing is not None:
                    raise missing
                return
            case _:
                return


def out_of_bounds(access: Access) -> CompileError | None:
    """The error of an access that starts outside its variable."""
    if 0 <= access.first < access.variable.size:
        return None
    return CompileError("index-out-of-bounds", (access.variable.name, access.first, access.variable.size), access.pos)


def elements(expression: Expression, count: int) -> list[Scalar]:
    """The first `count` elements as scalar expressions, or all if there are fewer."""
    return run(_elements(expression, count, False))


def first_element(expression: Expression) -> Expression:
    """Element 0. Raises CompileError if it does not exist."""
    return require(elements(expression, 1)[0])


def first_constant(expression: Expression) -> Expression:
    """Element 0, where each element at a computed index is replaced by a word that is never constant.

    Those indexes were evaluated when they were parsed; repeating it at each level would take quadratic time. Raises
    CompileError if the element does not exist or an index could not be evaluated.
    """
    return require(run(_elements(expression, 1, True))[0])


def require(scalar: Scalar) -> Expression:
    """An element. Raises CompileError if it does not exist."""
    if isinstance(scalar, MissingElement):
        raise scalar.error
    return scalar


def _elements(expression: Expression, count: int, is_opaque: bool) -> Task[list[Scalar]]:
    match expression:
        case Access(variable, first, last, pos):
            error = out_of_bounds(expression)
            if error is not None:
                return [MissingElement(error)] * min(count, last - first + 1)
            end = min(last + 1, variable.size, first + count)
            return [Word(variable.address + index, pos) for index in range(first, end)]
        case Subscript(variable, index, fault, pos):
            if isinstance(index, ListLiteral):
                total = yield _size(index)
                return [MissingElement(CompileError("illegal-index" if total > 2 else "list-as-index", (), pos))]
            if is_opaque:
                return [Word(variable.address, pos) if fault is None else MissingElement(fault)]
            first_index: list[Scalar] = yield _elements(index, 1, False)
            inner = first_index[0]
            return [inner if isinstance(inner, MissingElement) else Element(variable, inner, pos)]
        case Unary(operator, operand, pos):
            operands: list[Scalar] = yield _elements(operand, count, is_opaque)
            return [item if isinstance(item, MissingElement) else Unary(operator, item, pos) for item in operands]
        case Binary(operator, left, right, pos):
            lefts: list[Scalar] = yield _elements(left, count, is_opaque)
            rights: list[Scalar] = yield _elements(right, count, is_opaque)
            return [_paired(operator, one, two, pos) for one, two in zip(lefts, rights, strict=False)]
        case ListLiteral(items):
            gathered: list[Scalar] = []
            for item in items:
                gathered += yield _elements(item, count - len(gathered), is_opaque)
                if len(gathered) >= count:
                    break
            return gathered
    return [expression]


def _paired(operator: str, left: Scalar, right: Scalar, pos: SourcePos) -> Scalar:
    if isinstance(left, MissingElement):
        return left
    return right if isinstance(right, MissingElement) else Binary(operator, left, right, pos)
