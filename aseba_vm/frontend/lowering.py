"""Passes 4 and 5, lowering: compound assignments and loops to plain ones, vectors to scalars.

Source: docs/spec/aseba-bytecode-vm.md section 3.
"""

from __future__ import annotations

from dataclasses import replace

from aseba_vm.errors import CompileError, SourcePos
from aseba_vm.frontend.syntax_tree import (
    Access,
    Argument,
    Assignment,
    Binary,
    Block,
    Call,
    Compound,
    Element,
    ElementArgument,
    Emit,
    Expression,
    For,
    If,
    ListLiteral,
    Memory,
    Number,
    Statement,
    Subscript,
    Tree,
    Unary,
    While,
    Word,
)
from aseba_vm.frontend.trampoline import Task, run
from aseba_vm.frontend.vectors import elements, first_element, require, size_of

#: Limit of this compiler on the scalar operations of a program, far above the bytecode size of any node.
MAX_ELEMENTS = 300_000


def lower(tree: Tree, memory_size: int) -> Tree:
    """The scalar tree. Raises CompileError."""
    lowering = _Lowering(memory_size, tree.allocated, tree.temporaries)
    body: Block = run(lowering.block(tree.body))
    return replace(tree, body=body, temporaries=lowering.temporaries)


class _Lowering:
    """Lowers statements; counts temporary words and the remaining budget of operations."""

    def __init__(self, memory_size: int, allocated: int, temporaries: int) -> None:
        self.memory_size = memory_size
        self.allocated = allocated
        self.temporaries = temporaries
        self.budget = MAX_ELEMENTS

    def block(self, block: Block) -> Task[Block]:
        statements: list[Statement] = []
        for statement in block.statements:
            statements += yield self.statement(statement)
        return Block(tuple(statements))

    def statement(self, statement: Statement) -> Task[list[Statement]]:
        match statement:
            case Assignment(left, right, pos):
                return list(self.assign(left, right, pos))
            case Compound(operator, left, right, pos):
                if right is None:
                    right = ListLiteral((Number(1, pos),) * size_of(left), pos)
                return list(self.assign(left, Binary(operator, left, right, pos), pos))
            case If():
                return [(yield self.conditional(statement))]
            case While(condition, body, pos):
                condition = first_element(condition)
                return [While(condition, (yield self.block(body)), pos)]
            case For():
                lowered: list[Statement] = yield self.loop(statement)
                return lowered
            case Emit():
                return [replace(statement, setup=self.setup(statement.setup))]
            case Call():
                arguments = tuple(self.argument(argument) for argument in statement.arguments)
                return [replace(statement, arguments=arguments)]
        return [statement]

    def conditional(self, statement: If) -> Task[If]:
        condition = first_element(statement.condition)
        then: Block = yield self.block(statement.then)
        otherwise = statement.otherwise
        if isinstance(otherwise, If):
            otherwise = yield self.conditional(otherwise)
        elif otherwise is not None:
            otherwise = yield self.block(otherwise)
        return replace(statement, condition=condition, then=then, otherwise=otherwise)

    def loop(self, loop: For) -> Task[list[Statement]]:
        """Lower a `for` (docs/spec/aseba-bytecode-vm.md section 6)."""
        statements: list[Statement] = list(self.assign(loop.variable, loop.start, loop.start.pos))
        body: Block
        if loop.start.value == loop.end.value:
            body = yield self.block(loop.body)
            statements += body.statements
            return statements
        pos = loop.variable.pos
        comparison = "<=" if loop.start.value < loop.end.value else ">="
        condition = first_element(Binary(comparison, loop.variable, loop.end, loop.pos))
        body = yield self.block(loop.body)
        next_value = Binary("+", loop.variable, Number(loop.step, pos), pos)
        increment = self.assign(loop.variable, next_value, pos)
        statements.append(While(condition, Block(body.statements + increment), loop.pos))
        return statements

    def argument(self, argument: Argument | ElementArgument) -> Argument | ElementArgument:
        if isinstance(argument, Argument):
            return replace(argument, setup=self.setup(argument.setup))
        element = first_element(Subscript(argument.variable, argument.index, None, argument.pos))
        assert isinstance(element, Element)
        return replace(argument, index=element.index)

    def setup(self, setup: tuple[Assignment, ...]) -> tuple[Assignment, ...]:
        return tuple(
            scalar for assignment in setup for scalar in self.copy(assignment.left, assignment.right, assignment.pos)
        )

    def assign(self, left: Expression, right: Expression, pos: SourcePos) -> tuple[Assignment, ...]:
        """Lower an assignment, through temporary words if the right side reads what the left side writes."""
        size = size_of(left)
        if size == 1 or not isinstance(left, Access) or not _occurs(left.variable.name, right):
            return self.copy(left, right, pos)
        address = self.memory_size - self.temporaries - size
        self.temporaries += size
        if self.allocated + self.temporaries > self.memory_size:
            raise CompileError("out-of-temporary-memory", (), pos)
        temporary = Access(Memory("", address, size), 0, size - 1, pos)
        return self.copy(temporary, right, pos) + self.copy(left, temporary, pos)

    def copy(self, left: Expression, right: Expression, pos: SourcePos) -> tuple[Assignment, ...]:
        """One assignment per element. The right side of each is checked first, which fixes the error order."""
        size = size_of(right)
        self.budget -= size * run(_weight(right))
        if self.budget < 0:
            raise CompileError("too-many-elements", (MAX_ELEMENTS,), pos)
        scalars: list[Assignment] = []
        values = elements(right, size)
        places = elements(left, size)
        for value, place in zip(values, places, strict=True):
            source = require(value)
            destination = require(place)
            if isinstance(destination, Number):
                raise CompileError("not-assignable", ("constant-list",), pos)
            if not isinstance(destination, Word | Element):
                raise CompileError("not-assignable", ("binary-operation",), pos)
            scalars.append(Assignment(destination, source, pos))
        return tuple(scalars)


def _weight(expression: Expression) -> Task[int]:
    """The maximum number of nodes in one element of the expression."""
    weight: int
    match expression:
        case Unary(_, operand, _):
            weight = yield _weight(operand)
            return weight + 1
        case Binary(_, left, right, _):
            weight = yield _weight(left)
            other: int = yield _weight(right)
            return weight + other + 1
        case ListLiteral(items):
            weight = 1
            for item in items:
                weight = max(weight, (yield _weight(item)))
            return weight
    return 1


def _occurs(name: str, expression: Expression) -> bool:
    """Whether a variable of this name is read anywhere, including inside indexes."""
    stack = [expression]
    while stack:
        match stack.pop():
            case Access(variable):
                if variable.name == name:
                    return True
            case Subscript(variable, index):
                if variable.name == name:
                    return True
                stack.append(index)
            case Unary(_, operand):
                stack.append(operand)
            case Binary(_, left, right):
                stack += (left, right)
            case ListLiteral(items):
                stack += items
    return False
