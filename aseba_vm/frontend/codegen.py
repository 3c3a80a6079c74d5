"""Passes 8 to 10, code generation: tree to instructions, terminators, stack check.

Source: docs/spec/aseba-bytecode-vm.md sections 4 to 9.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from aseba_vm.bytecode import BINARY_NUMBER, EDGE, LENGTH, UNARY_NUMBER, Instruction, Op, Segment
from aseba_vm.errors import CompileError, SourcePos
from aseba_vm.frontend.symbols import INIT_EVENT
from aseba_vm.frontend.syntax_tree import (
    Argument,
    Assignment,
    Binary,
    Block,
    Call,
    CallSub,
    Element,
    ElementArgument,
    Emit,
    Expression,
    If,
    Number,
    OnEvent,
    Return,
    Statement,
    Sub,
    Tree,
    Unary,
    While,
    Word,
)
from aseba_vm.frontend.trampoline import Task, run

_MAX_JUMP = 2047
"""Longest jump in words that 12 bits can hold."""


def generate(tree: Tree) -> tuple[Segment, ...]:
    """The terminated code of each event that has any, in source order, and of every subroutine."""
    initial = _SegmentBuilder(is_sub=False, number=INIT_EVENT, name="", row=0)
    builders = [initial]
    numbers = {sub.name: sub.index for sub in tree.subs}
    current = initial
    for statement in tree.body.statements:
        if isinstance(statement, OnEvent):
            current = _SegmentBuilder(False, statement.number, statement.name, statement.pos.row)
            builders.append(current)
        elif isinstance(statement, Sub):
            current = _SegmentBuilder(True, statement.index, statement.name, statement.pos.row)
            current.last_row = statement.pos.row
            builders.append(current)
        else:
            current.subs = numbers
            current.depth = max(current.depth, run(current.statement(statement)))
    return tuple(builder.finish() for builder in builders if builder.is_sub or builder.code)


def check_stack(segments: Sequence[Segment], stack_size: int) -> int:
    """The estimated maximum stack depth, including calls. Raises CompileError if it exceeds the stack.

    Source: docs/spec/aseba-bytecode-vm.md section 8.
    """
    subs = [segment for segment in segments if segment.is_sub]
    calls = [[code.operand for code in sub.code if code.op is Op.CALL] for sub in subs]
    call_depth = [0] * len(subs)
    deepest = 0
    for segment in segments:
        if segment.is_sub:
            continue
        deepest = max(deepest, segment.depth)
        if segment.depth > stack_size:
            raise CompileError("stack-overflow")
        for code in segment.code:
            if code.op is Op.CALL:
                call_depth[code.operand] = 1
    changed = True
    while changed:
        changed = False
        for index, sub in enumerate(subs):
            deepest = max(deepest, call_depth[index] + sub.depth)
            if deepest > stack_size:
                raise CompileError("stack-overflow")
            for called in calls[index]:
                if call_depth[called] < call_depth[index] + 1:
                    call_depth[called] = call_depth[index] + 1
                    changed = True
    return deepest


@dataclass(slots=True)
class _SegmentBuilder:
    """Code of one segment. The methods append code and return its stack depth as a task."""

    is_sub: bool
    number: int
    name: str
    row: int
    depth: int = 0
    code: list[Instruction] = field(default_factory=list)
    size: int = 0
    last_row: int | None = 0
    subs: dict[str, int] = field(default_factory=dict)
    far_blocks: list[SourcePos] = field(default_factory=list)
    skips_to: int = -1
    """Size of the code at the most recent branch target."""

    def add(self, op: Op, operand: int, row: int | None, *more: int) -> None:
        self.code.append(Instruction(op, operand, more, row))
        self.size += LENGTH[op]
        self.last_row = row

    def finish(self) -> Segment:
        """Append the terminator (docs/spec/aseba-bytecode-vm.md section 7)."""
        falls_through = False
        if self.is_sub:
            self.code = [replace(code, op=Op.RET) if code.op is Op.STOP else code for code in self.code]
            if not self.code or self.code[-1].op is not Op.RET:
                self.add(Op.RET, 0, self.last_row)
            else:
                falls_through = self.skips_to == self.size
        else:
            self.add(Op.STOP, 0, self.last_row)
        return Segment(
            self.is_sub,
            self.number,
            self.name,
            tuple(self.code),
            self.depth,
            self.row,
            falls_through,
            tuple(self.far_blocks),
        )

    # -- expressions

    def expression(self, expression: Expression) -> Task[int]:
        row = expression.pos.row
        match expression:
            case Number(value, _):
                self.constant(value, row)
                return 1
            case Word(address, _):
                self.add(Op.LOAD, address, row)
                return 1
            case Element(variable, index, _):
                depth: int = yield self.expression(index)
                self.add(Op.LOADX, variable.address, row, variable.size)
                return depth
            case Unary(operator, operand, _):
                depth = yield self.expression(operand)
                self.add(Op.UNARY, UNARY_NUMBER[operator], row)
                return depth
            case Binary(operator, left, right, _):
                depth = yield self.expression(left)
                depth += yield self.expression(right)
                self.add(Op.BINARY, BINARY_NUMBER[operator], row)
                return depth
        raise AssertionError(expression)

    def constant(self, value: int, row: int) -> None:
        """Push a constant. The 32-bit value decides whether the short form is used."""
        if abs(value) <= 2047:
            self.add(Op.PUSH, value & 0xFFF, row)
        else:
            self.add(Op.PUSHL, 0, row, value)

    # -- statements

    def statement(self, statement: Statement) -> Task[int]:
        depth: int
        match statement:
            case Block(statements):
                depths: list[int] = []
                for inner in statements:
                    depths += [(yield self.statement(inner))]
                return max(depths, default=0)
            case Assignment():
                depth = yield self.assignment(statement)
                return depth
            case If():
                depth = yield self.conditional(statement)
                return depth
            case While():
                depth = yield self.loop(statement)
                return depth
            case Emit(number, address, size, setup, pos):
                depth = yield self.setup(setup)
                self.add(Op.EMIT, number, pos.row, address, size)
                return depth
            case Call():
                depth = yield self.call(statement)
                return depth
            case CallSub(name, pos):
                self.add(Op.CALL, self.subs[name], pos.row)
            case Return(pos):
                self.add(Op.STOP, 0, pos.row)
        return 0

    def setup(self, setup: tuple[Assignment, ...]) -> Task[int]:
        depths: list[int] = []
        for assignment in setup:
            depths += [(yield self.assignment(assignment))]
        return max(depths, default=0)

    def assignment(self, assignment: Assignment) -> Task[int]:
        depth: int = yield self.expression(assignment.right)
        index_depth: int
        match assignment.left:
            case Word(address, pos):
                self.add(Op.STORE, address, pos.row)
            case Element(variable, index, pos):
                index_depth = yield self.expression(index)
                depth = max(depth, index_depth)
                self.add(Op.STOREX, variable.address, pos.row, variable.size)
        return depth

    def condition(self, condition: Expression, flags: int, row: int) -> Task[tuple[int, int]]:
        """Append both operands and a BRANCH without offset.

        Returns:
            The stack depth, and the index of the BRANCH in the code.
        """
        assert isinstance(condition, Binary)
        depth: int = yield self.expression(condition.left)
        depth += yield self.expression(condition.right)
        self.add(Op.BRANCH, BINARY_NUMBER[condition.operator] | flags, row, 0)
        return depth, len(self.code) - 1

    def conditional(self, statement: If) -> Task[int]:
        row = statement.pos.row
        depth: int
        branch: int
        depth, branch = yield self.condition(statement.condition, EDGE if statement.is_edge else 0, row)
        start = self.size - 2
        then_depth: int = yield self.statement(statement.then)
        depth = max(depth, then_depth)
        if statement.otherwise is not None:
            jump, jump_at = len(self.code), self.size
            self.add(Op.JUMP, 0, self.code[-1].row if jump > branch + 1 else row)
            self.code[branch] = replace(self.code[branch], more=(self.size - start,))
            otherwise_depth: int = yield self.statement(statement.otherwise)
            depth = max(depth, otherwise_depth)
            self.code[jump] = replace(self.code[jump], operand=self.size - jump_at)
            if self.size - jump_at > _MAX_JUMP:
                self.far_blocks.append(statement.pos)
        else:
            self.code[branch] = replace(self.code[branch], more=(self.size - start,))
        self.skips_to = self.size
        self.last_row = statement.end_row
        return depth

    def loop(self, loop: While) -> Task[int]:
        row = loop.pos.row
        begin = self.size
        depth: int
        branch: int
        depth, branch = yield self.condition(loop.condition, 0, row)
        start = self.size - 2
        body_depth: int = yield self.statement(loop.body)
        if self.size - begin > _MAX_JUMP:
            self.far_blocks.append(loop.pos)
        self.add(Op.JUMP, (begin - self.size) & 0xFFF, row)
        self.code[branch] = replace(self.code[branch], more=(self.size - start,))
        self.skips_to = self.size
        return max(depth, body_depth)

    # -- natives

    def call(self, call: Call) -> Task[int]:
        row = call.pos.row
        for size in reversed(call.sizes):
            self.constant(size, row)
        depth = 0
        for index in range(len(call.arguments) - 1, -1, -1):
            argument_depth: int = yield self.argument(call.arguments[index])
            depth = max(depth, len(call.sizes) + index + argument_depth)
        self.add(Op.NATIVE, call.number, row)
        return depth

    def argument(self, argument: Argument | ElementArgument) -> Task[int]:
        depth: int
        row = argument.pos.row
        if isinstance(argument, ElementArgument):
            word = argument.temporary
            depth = yield self.expression(argument.index)
            self.add(Op.STORE, word, row)
            self.add(Op.LOAD, word, row)
            self.add(Op.LOAD, word, row)
            self.add(Op.LOADX, argument.variable.address, row, argument.variable.size)
            self.add(Op.STORE, word, row)
            self.constant(argument.variable.address, row)
            self.add(Op.BINARY, BINARY_NUMBER["+"], row)
            return max(depth, 2)
        depth = yield self.setup(argument.setup)
        self.constant(argument.address, row)
        return max(depth, 1)
