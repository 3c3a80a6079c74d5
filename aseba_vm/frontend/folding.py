"""Pass 7: constant folding and simplification of a scalar tree (docs/spec/aseba-language.md section 9)."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from dataclasses import replace

from aseba_vm.errors import CompileError, SourcePos
from aseba_vm.frontend.syntax_tree import (
    CONNECTIVES,
    Argument,
    Assignment,
    Binary,
    Block,
    Call,
    Element,
    ElementArgument,
    Emit,
    Expression,
    If,
    Number,
    Statement,
    Tree,
    Unary,
    While,
    Word,
)
from aseba_vm.frontend.trampoline import Task, run


def optimize(tree: Tree) -> Tree:
    """The tree with constants folded and statements without effect removed. Raises CompileError."""
    return replace(tree, body=run(_block(tree.body)))


def simplify(expression: Expression) -> Expression:
    """A scalar expression, folded and simplified. Raises CompileError."""
    return run(_expression(expression))


# -- expressions -------------------------------------------------------------------------------------------------------


def _wrap32(value: int) -> int:
    return ((value + 0x80000000) & 0xFFFFFFFF) - 0x80000000


def _quotient(left: int, right: int) -> int:
    quotient = abs(left) // abs(right)
    return quotient if (left < 0) == (right < 0) else -quotient


_FOLD: Mapping[str, Callable[[int, int], int]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": _quotient,
    "%": lambda left, right: left - right * _quotient(left, right),
    "<<": lambda left, right: left << (right & 31),
    ">>": lambda left, right: left >> (right & 31),
    "|": operator.or_,
    "^": operator.xor,
    "&": operator.and_,
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "or": lambda left, right: bool(left) or bool(right),
    "and": lambda left, right: bool(left) and bool(right),
}

_OPPOSITE: Mapping[str, str] = {
    "==": "!=",
    "!=": "==",
    "<": ">=",
    ">=": "<",
    ">": "<=",
    "<=": ">",
    "or": "and",
    "and": "or",
}


def _expression(expression: Expression) -> Task[Expression]:
    match expression:
        case Binary(_, left, right, pos):
            left = yield _expression(left)
            right = yield _expression(right)
            return _binary(Binary(expression.operator, left, right, pos))
        case Unary(symbol, operand, pos):
            operand = yield _expression(operand)
            if isinstance(operand, Number):
                return Number(_fold_unary(symbol, operand.value, pos), pos)
            if symbol == "not" and isinstance(operand, Binary):
                inverted: Expression = yield _inverted(operand)
                return inverted
            return Unary(symbol, operand, pos)
        case Element(variable, index, pos):
            index = yield _expression(index)
            if not isinstance(index, Number):
                return Element(variable, index, pos)
            if not 0 <= index.value < variable.size:
                arguments = (index.value, variable.name, variable.size)
                raise CompileError("static-read-out-of-bounds", arguments, pos)
            return Word(variable.address + index.value, pos)
    return expression


def _fold_unary(symbol: str, value: int, pos: SourcePos) -> int:
    if symbol == "-":
        return _wrap32(-value)
    if symbol == "~":
        return ~value
    if symbol == "not":
        return int(value == 0)
    if value == -32768:
        raise CompileError("abs-of-minimum", (), pos)
    return _wrap32(abs(value))


def _binary(node: Binary) -> Expression:
    """Apply rules 1 and 3 to 6 to an operation with simplified operands."""
    symbol, left, right, pos = node.operator, node.left, node.right, node.pos
    if isinstance(right, Number):
        value = right.value
        if value == 0 and (symbol == "/" or (symbol == "%" and isinstance(left, Number))):
            raise CompileError("division-by-zero", (), pos)
        if isinstance(left, Number):
            if value == -1 and left.value == -0x80000000 and symbol in "/%":
                raise CompileError("constant-overflow", (), pos)
            return Number(_wrap32(int(_FOLD[symbol](left.value, value))), pos)
        if symbol in ("*", "/") and value == 1:
            return left
        if symbol in ("*", "/") and value > 1 and value & (value - 1) == 0:
            shift = Number(value.bit_length() - 1, right.pos)
            return Binary("<<" if symbol == "*" else ">>", left, shift, pos)
        if symbol == "-" and value == 0:
            return left
        return _commutative(node, left, value)
    if isinstance(left, Number):
        return _commutative(node, right, left.value)
    return node


def _commutative(node: Binary, other: Expression, value: int) -> Expression:
    """Apply the neutral and absorbing operands that are valid on both sides."""
    symbol = node.operator
    if symbol == "*":
        return other if value == 1 else Number(0, node.pos) if value == 0 else node
    if symbol == "+":
        return other if value == 0 else node
    if symbol == "|":
        return other if value == 0 else Number(-1, node.pos) if value == -1 else node
    if symbol == "&":
        return other if value == -1 else Number(0, node.pos) if value == 0 else node
    if symbol == "or":
        return other if value == 0 else Number(1, node.pos)
    if symbol == "and":
        return other if value != 0 else Number(0, node.pos)
    return node


def _inverted(node: Expression) -> Task[Expression]:
    """Move a `not` into a simplified operation (rule 7)."""
    if not isinstance(node, Binary) or node.operator not in _OPPOSITE:
        raise CompileError("negated-number", (), node.pos)
    left, right = node.left, node.right
    if node.operator in CONNECTIVES:
        left = yield _inverted(left)
        right = yield _inverted(right)
    return Binary(_OPPOSITE[node.operator], left, right, node.pos)


# -- statements --------------------------------------------------------------------------------------------------------


def _block(block: Block) -> Task[Block]:
    kept: list[Statement] = []
    for statement in block.statements:
        simpler: Statement | None = yield _statement(statement)
        if isinstance(simpler, Block):
            kept.extend(simpler.statements)
        elif simpler is not None:
            kept.append(simpler)
    return Block(tuple(kept))


def _statement(statement: Statement) -> Task[Statement | None]:
    """The simplified statement, or None if it is removed."""
    match statement:
        case Assignment():
            assignment: Assignment = yield _assignment(statement)
            return assignment
        case If():
            simpler: Statement | None = yield _if(statement)
            return simpler
        case While(condition, body, pos):
            condition = yield _expression(condition)
            body = yield _block(body)
            if isinstance(condition, Number):
                if condition.value != 0:
                    raise CompileError("infinite-loop", (), pos)
                return None
            return While(condition, body, pos) if body.statements else None
        case Emit():
            return replace(statement, setup=(yield _setup(statement.setup)))
        case Call():
            arguments: list[Argument | ElementArgument] = []
            for argument in statement.arguments:
                if isinstance(argument, Argument):
                    arguments.append(replace(argument, setup=(yield _setup(argument.setup))))
                else:
                    arguments.append(replace(argument, index=(yield _expression(argument.index))))
            return replace(statement, arguments=tuple(arguments))
        case Block():
            block: Block = yield _block(statement)
            return block
    return statement


def _setup(setup: tuple[Assignment, ...]) -> Task[tuple[Assignment, ...]]:
    simpler: list[Assignment] = []
    for assignment in setup:
        simpler += [(yield _assignment(assignment))]
    return tuple(simpler)


def _assignment(assignment: Assignment) -> Task[Assignment]:
    left: Expression = assignment.left
    if isinstance(left, Element):
        index: Expression = yield _expression(left.index)
        if not isinstance(index, Number):
            left = Element(left.variable, index, left.pos)
        elif 0 <= index.value < left.variable.size:
            left = Word(left.variable.address + index.value, left.pos)
        else:
            arguments = (index.value, left.variable.name, left.variable.size)
            raise CompileError("static-write-out-of-bounds", arguments, left.pos)
    right: Expression = yield _expression(assignment.right)
    return Assignment(left, right, assignment.pos)


def _if(statement: If) -> Task[Statement | None]:
    condition: Expression = yield _expression(statement.condition)
    then: Block = yield _block(statement.then)
    otherwise = statement.otherwise
    if isinstance(otherwise, If):
        otherwise = yield _if(otherwise)
    elif otherwise is not None:
        otherwise = yield _block(otherwise)
    if not then.statements and (otherwise is None or _is_empty(otherwise)):
        return None
    if isinstance(condition, Number):
        return then if condition.value != 0 else otherwise
    return replace(statement, condition=condition, then=then, otherwise=otherwise)


def _is_empty(statement: Block | If) -> bool:
    return isinstance(statement, Block) and not statement.statements
