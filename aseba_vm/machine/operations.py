"""Operations of the machine: arithmetic by operator, and words decoded for the interpreter loop.

Source: docs/spec/aseba-bytecode-vm.md sections 1 and 10.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any

from aseba_vm.bytecode import EDGE, Op, signed, signed12
from aseba_vm.kernel.integers import quotient, remainder, wrap

# Kinds of decoded operations, frequent ones first: the order in which the loop tests them. OTHER: what it leaves out.
LOAD = 0
PUSH = 1
STORE = 2
BINARY = 3
IF = 4
JUMP = 5
LOADX = 6
STOREX = 7
WHEN = 8
UNARY = 9
CALL = 10
RET = 11
OTHER = 12
BRANCHES = (IF, WHEN)

Decoded = tuple[int, Any, Any]
"""Kind, and two operands whose meaning depends on the kind."""


#: Indexed by the number of the operator.
BINARY_FUNCTIONS: Sequence[Callable[[int, int], int]] = (
    lambda left, right: wrap(left << (right & 31)),
    lambda left, right: left >> (right & 31),
    lambda left, right: wrap(left + right),
    lambda left, right: wrap(left - right),
    lambda left, right: wrap(left * right),
    lambda left, right: wrap(quotient(left, right)),
    remainder,
    lambda left, right: left | right,
    lambda left, right: left ^ right,
    lambda left, right: left & right,
    lambda left, right: 1 if left == right else 0,
    lambda left, right: 1 if left != right else 0,
    lambda left, right: 1 if left > right else 0,
    lambda left, right: 1 if left >= right else 0,
    lambda left, right: 1 if left < right else 0,
    lambda left, right: 1 if left <= right else 0,
    lambda left, right: 1 if left or right else 0,
    lambda left, right: 1 if left and right else 0,
)

UNARY_FUNCTIONS: Sequence[Callable[[int], int]] = (
    lambda value: wrap(-value),
    lambda value: wrap(abs(value)),
    lambda value: ~value,
)


@lru_cache(1 << 14)
def decode(word: int, second: int) -> Decoded:
    """Kind and operands of the operation that starts with `word`, given the word after it."""
    op, operand = word >> 12, word & 0xFFF
    match op:
        case Op.PUSH:
            return (PUSH, signed12(word), 1)
        case Op.PUSHL:
            return (PUSH, signed(second), 2)
        case Op.LOAD:
            return (LOAD, operand, 0)
        case Op.STORE:
            return (STORE, operand, 0)
        case Op.LOADX:
            return (LOADX, operand, second)
        case Op.STOREX:
            return (STOREX, operand, second)
        case Op.UNARY if operand < len(UNARY_FUNCTIONS):
            return (UNARY, UNARY_FUNCTIONS[operand], 0)
        case Op.BINARY if operand < len(BINARY_FUNCTIONS):
            return (BINARY, BINARY_FUNCTIONS[operand], 0)
        case Op.BRANCH if operand & 0xFF < len(BINARY_FUNCTIONS):
            return (WHEN if operand & EDGE else IF, BINARY_FUNCTIONS[operand & 0xFF], signed(second))
        case Op.JUMP:
            return (JUMP, signed12(word), 0)
        case Op.CALL:
            return (CALL, operand, 0)
        case Op.RET:
            return (RET, 0, 0)
    return (OTHER, 0, 0)
