"""Pass 3: sizes of vectors; pass 6: types and subroutines of the scalar tree.

Source: docs/spec/aseba-language.md sections 8 and 11.
"""

from __future__ import annotations

from aseba_vm.errors import CompileError, SourcePos
from aseba_vm.frontend.suggestions import unknown_name_error
from aseba_vm.frontend.syntax_tree import (
    COMPARISONS,
    CONNECTIVES,
    Assignment,
    Binary,
    Block,
    CallSub,
    Compound,
    Expression,
    For,
    If,
    Statement,
    Sub,
    Tree,
    Unary,
    While,
)
from aseba_vm.frontend.trampoline import Task, run
from aseba_vm.frontend.vectors import size_of


def check_sizes(tree: Tree) -> None:
    """Check that both sides of each assignment have the same size and each condition size 1. Raises CompileError."""
    run(_sizes(tree.body))


def _sizes(statement: Statement) -> Task[None]:
    match statement:
        case Block(statements):
            for inner in statements:
                if isinstance(inner, Assignment):
                    _check_equal(inner.left, inner.right, inner.pos)
                else:
                    yield _sizes(inner)
        case Assignment(left, right, pos):
            _check_equal(left, right, pos)
        case Compound(_, left, right, pos):
            if right is None:
                size_of(left)
            else:
                _check_equal(left, right, pos)
        case If(_, condition, then, otherwise, pos, _):
            if size_of(condition) != 1:
                raise CompileError("vector-condition-if", (), pos)
            yield _sizes(then)
            if otherwise is not None:
                yield _sizes(otherwise)
        case While(condition, body, pos):
            if size_of(condition) != 1:
                raise CompileError("vector-condition-while", (), pos)
            yield _sizes(body)
        case For(variable, start, _, _, body, _):
            _check_equal(variable, start, start.pos)
            yield _sizes(body)


def _check_equal(left: Expression, right: Expression, pos: SourcePos) -> None:
    sizes = (size_of(left), size_of(right))
    if sizes[0] != sizes[1]:
        raise CompileError("size-mismatch", sizes, pos)


def check_types(tree: Tree) -> None:
    """Check the types of a scalar tree and the existence of subroutines. Raises CompileError."""
    run(_types(tree.body, {sub.name: sub for sub in tree.subs}))


def _types(statement: Statement, subs: dict[str, Sub]) -> Task[None]:
    match statement:
        case Block(statements):
            for inner in statements:
                yield _types(inner, subs)
        case Assignment(_, right, pos):
            found: str = yield _type_of(right)
            _expect("integer", found, pos)
        case If(_, condition, then, otherwise, pos, _):
            found = yield _type_of(condition)
            _expect("boolean", found, pos)
            yield _types(then, subs)
            if otherwise is not None:
                yield _types(otherwise, subs)
        case While(condition, body, pos):
            found = yield _type_of(condition)
            _expect("boolean", found, pos)
            yield _types(body, subs)
        case CallSub(name, pos):
            if name not in subs:
                raise unknown_name_error("unknown-subroutine", name, subs, pos)


def _type_of(expression: Expression) -> Task[str]:
    """`integer` or `boolean`; indexes are not checked."""
    match expression:
        case Unary(operator, operand, pos):
            wanted = "boolean" if operator == "not" else "integer"
            found: str = yield _type_of(operand)
            _expect(wanted, found, pos)
            return wanted
        case Binary(operator, left, right, pos):
            wanted = "boolean" if operator in CONNECTIVES else "integer"
            left_type: str = yield _type_of(left)
            _expect(wanted, left_type, pos)
            right_type: str = yield _type_of(right)
            _expect(wanted, right_type, pos)
            return "boolean" if operator in CONNECTIVES or operator in COMPARISONS else "integer"
    return "integer"


def _expect(wanted: str, found: str, pos: SourcePos) -> None:
    if wanted != found:
        raise CompileError("type-mismatch", (wanted, found), pos)
