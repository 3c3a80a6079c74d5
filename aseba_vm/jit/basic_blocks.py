"""Bytecode as basic blocks of statements over expression trees: the input of the translator.

Symbolic execution turns stack operations back into trees. A statement is the smallest unit with an effect. Between
statements the state of the machine is known: `pc`, and a stack that holds only `pending`, constants and
temporaries. Code that cannot be translated, or that fails at run time, therefore exits *before* its statement, and the
interpreter repeats it exactly (see `aseba_vm.jit.tiering`). Only code that is reachable from the event table is
decoded.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from aseba_vm.bytecode import EDGE, LENGTH, MAX_EMITTED, Op, signed, signed12
from aseba_vm.jit.ir import (
    Assign,
    AssignIndex,
    BailOut,
    Binary,
    Branch,
    Call,
    Const,
    Emit,
    End,
    EnterSub,
    Expr,
    Index,
    Jump,
    Load,
    ProgramPoint,
    Return,
    Statement,
    Stop,
    Temp,
    Unary,
    arguments,
    words_of,
)
from aseba_vm.machine.costs import FREE, Cost
from aseba_vm.machine.native_call import Signature

_BINARY_COUNT = 18
_UNARY_COUNT = 3


@dataclass(frozen=True, slots=True)
class Block:
    """Statements in order, and how the block ends. `depth` is the maximum number of words it adds to the stack."""

    pc: int
    statements: tuple[Statement, ...]
    end: End
    depth: int


@dataclass(frozen=True, slots=True)
class Memories:
    """The properties of a machine that translation depends on: sizes in words, natives, cost of an event."""

    variables: int
    bytecode: int
    stack: int
    natives: tuple[Signature, ...]
    emit: Cost = FREE


@dataclass(frozen=True, slots=True)
class Blocks:
    """The blocks of a program by address, and the addresses of its branches in ascending order.

    `jumps` has the address and target of each JUMP, `operands` the words that are not instructions. `is_fragile`:
    one of the operands would modify itself if it were executed as an instruction.
    """

    by_address: dict[int, Block]
    branches: tuple[int, ...]
    jumps: dict[int, int]
    is_fragile: bool
    operands: dict[int, int]
    memories: Memories


def find_blocks(words: Sequence[int], memories: Memories) -> Blocks | None:
    """The blocks of a program, or None if a branch word, which changes, also has another meaning."""
    size = len(words)
    if not size:
        return None
    # The event table: its size in word 0, then pairs of number and address. Code starts behind it.
    first = min(words[0], size - 1)
    events = [words[index + 1] for index in range(1, first, 2) if index + 1 < size]
    leaders = {address for address in events if address < size}
    instructions = _reach(words, leaders)
    branches = tuple(sorted(pc for pc in instructions if words[pc] >> 12 == Op.BRANCH))
    operands = {
        place: words[place] for pc in instructions for place in range(pc + 1, min(pc + LENGTH[words[pc] >> 12], size))
    }
    # A `when` stores its edge flag in the word of its BRANCH. If this word is an operand or a part of the table, too,
    # its value changes as the program runs, and no translation stays valid.
    if any(pc in operands or pc <= first for pc in branches):
        return None
    builder = _Builder(words, memories, leaders)
    return Blocks(
        by_address={pc: builder.block(pc) for pc in sorted(leaders)},
        branches=branches,
        jumps={pc: pc + signed12(words[pc]) for pc in instructions if words[pc] >> 12 == Op.JUMP},
        is_fragile=any(word >> 12 == Op.BRANCH for word in operands.values()),
        operands=operands,
        memories=memories,
    )


def _reach(words: Sequence[int], leaders: set[int]) -> set[int]:
    """The addresses of all reachable instructions. The starts of blocks are added to `leaders`."""
    size = len(words)
    reachable: set[int] = set()
    waiting = sorted(leaders)
    while waiting:
        pc = waiting.pop()
        while pc < size and pc not in reachable:
            reachable.add(pc)
            word = words[pc]
            op = word >> 12
            targets: tuple[int, ...] = ()
            if op == Op.JUMP:
                targets = (pc + signed12(word),)
            elif op == Op.BRANCH:
                targets = (pc + signed(words[pc + 1] if pc + 1 < size else 0), pc + 2)
            elif op == Op.CALL:
                targets = (word & 0xFFF, pc + 1)
            for target in targets:
                if 0 <= target < size:
                    leaders.add(target)
                    waiting.append(target)
            if targets or op in (Op.STOP, Op.RET, Op.UNKNOWN):
                break
            pc += LENGTH[op]
    return reachable


class _Builder:
    """Executes blocks symbolically: `stack` holds expression trees instead of words."""

    def __init__(self, words: Sequence[int], memories: Memories, leaders: set[int]) -> None:
        self.words = [*words, 0, 0]
        self.size = len(words)
        self.memories = memories
        self.leaders = leaders

    def block(self, start: int) -> Block:
        self.stack: list[Expr] = []
        self.statements: list[Statement] = []
        self.place = ProgramPoint(start, ())
        self.cost = 0
        self.depth = 0
        self.temps = 0
        pc = start
        end: End | None = None
        while end is None:
            if pc >= self.size:
                end = BailOut(self.place, 0)
            elif pc != start and pc in self.leaders:
                # A block may run into the next one only between statements: a statement that is split by a branch
                # target has no state that both blocks know.
                end = BailOut(self.place, 0) if self.cost or self.stack else Jump(self.place, 0, -1, pc)
            else:
                self.cost += 1
                end = self._instruction(pc)
                self.depth = max(self.depth, len(self.stack))
                pc += LENGTH[self.words[pc] >> 12]
        return Block(start, tuple(self.statements), end, self.depth)

    def _instruction(self, pc: int) -> End | None:
        """Execute one instruction, and return the end of the block if the block ends there."""
        word, second, third = self.words[pc : pc + 3]
        op, operand = word >> 12, word & 0xFFF
        stack = self.stack
        memory = self.memories.variables
        match op:
            case Op.PUSH:
                stack.append(Const(signed12(word)))
            case Op.PUSHL:
                stack.append(Const(signed(second)))
            case Op.LOAD if operand < memory:
                stack.append(Load(operand))
            case Op.STORE if stack and operand < memory:
                value = stack.pop()
                self.statements.append(Assign(self.place, self.cost, self._spill(), operand, value))
                self._start_statement(pc + 1)
            case Op.LOADX if stack and operand + second <= memory:
                stack.append(Index(operand, second, stack.pop()))
            case Op.STOREX if len(stack) > 1 and operand + second <= memory:
                index, value = stack.pop(), stack.pop()
                place, keep = self.place, self._spill()
                self.statements.append(AssignIndex(place, self.cost, keep, operand, second, index, value))
                self._start_statement(pc + 2)
            case Op.UNARY if stack and operand < _UNARY_COUNT:
                stack.append(Unary(operand, stack.pop()))
            case Op.BINARY if len(stack) > 1 and operand < _BINARY_COUNT:
                right, left = stack.pop(), stack.pop()
                stack.append(Binary(operand, left, right))
            case Op.EMIT if second + third <= memory and third <= MAX_EMITTED:
                self.cost += self.memories.emit.of(third)
                self.statements.append(Emit(self.place, self.cost, self._spill(), operand, second, third))
                self._start_statement(pc + 3)
            case Op.NATIVE if operand < len(self.memories.natives):
                return self._native(pc, operand)
            case _:
                return self._end(pc, op, word, second)
        return None

    def _native(self, pc: int, number: int) -> End | None:
        """Execute a native call; bail out if its cost or validity is known only at run time."""
        signature = self.memories.natives[number]
        count = signature.count
        if len(self.stack) < count:
            return BailOut(self.place, 0)
        popped = tuple(self.stack[len(self.stack) - count :][::-1])
        del self.stack[len(self.stack) - count :]
        words = words_of(popped, signature) if signature.cost.per_word else 0
        if words is None:  # the cost is known only at run time
            return BailOut(self.place, 0)
        place, cost = self.place, self.cost + signature.cost.of(words)
        known = arguments(popped, signature) or ()
        if any(address + size > self.memories.variables for address, size in known):
            return BailOut(place, 0)
        keep = self._spill()
        # Started before it is appended: a call has two exits, one to repeat it and one behind it (`self.place`).
        self._start_statement(pc + 1)
        self.statements.append(Call(place, cost, keep, number, popped, pc, self.place))
        return None

    def _end(self, pc: int, op: int, word: int, second: int) -> End:
        """The end of the block for a control-flow instruction, a bail-out if it cannot be translated."""
        stack, place, cost = self.stack, self.place, self.cost
        if op == Op.BRANCH and len(stack) == 2 and word & 0xFF < _BINARY_COUNT:
            left, right = stack
            operator, is_edge = word & 0xFF, bool(word & EDGE)
            return Branch(place, cost, pc, operator, left, right, is_edge, pc + 2, pc + signed(second))
        if not stack:
            target = pc + signed12(word)
            if op == Op.STOP:
                return Stop(place, cost)
            if op == Op.JUMP and 0 <= target < self.size:
                return Jump(place, cost, pc, target)
            if op == Op.CALL and word & 0xFFF < self.size:
                self.depth = max(self.depth, 1)
                return EnterSub(place, cost, word & 0xFFF, pc + 1)
            if op == Op.RET:
                return Return(place, cost)
        return BailOut(place, 0)

    def _spill(self) -> tuple[tuple[Temp, Expr], ...]:
        """Replace expressions on the stack by temporaries, and return their values; constants stay.

        A statement may change memory that the expressions read, so they must be evaluated before it.
        """
        kept: list[tuple[Temp, Expr]] = []
        for place, expression in enumerate(self.stack):
            if not isinstance(expression, Const | Temp):
                temp = Temp(self.temps)
                self.temps += 1
                kept.append((temp, expression))
                self.stack[place] = temp
        return tuple(kept)

    def _start_statement(self, pc: int) -> None:
        """Start the next statement at `pc`."""
        self.place = ProgramPoint(pc, tuple(atom for atom in self.stack if isinstance(atom, Const | Temp)))
        self.cost = 0
