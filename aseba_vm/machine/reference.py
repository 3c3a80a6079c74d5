"""The machine instruction by instruction, one function per operation: the reference for all engines.

Source: docs/spec/aseba-bytecode-vm.md sections 7 to 10.3.

An operation takes the machine and its word, and returns the address of the next instruction. Steps, breakpoints and
traces execute these functions, and so do instructions that the quick loop (`aseba_vm.machine.interpreter`) leaves out.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Protocol

from aseba_vm.bytecode import EDGE, MAX_EMITTED, Op, signed, signed12
from aseba_vm.machine.code_memory import CodeMemory
from aseba_vm.machine.costs import Costs
from aseba_vm.machine.data_memory import Variables
from aseba_vm.machine.machine_messages import BadCode, DivisionByZero, Emitted, Fault, Message, OutOfBounds
from aseba_vm.machine.native_table import NativeTable
from aseba_vm.machine.operations import BINARY_FUNCTIONS, UNARY_FUNCTIONS
from aseba_vm.target import TargetDescription

ACTIVE = 1
"""Flag of a machine that is executing an event."""


class InterpretedMachine(Protocol):
    """The part of a machine that both interpreter loops use."""

    target: TargetDescription
    costs: Costs
    natives: NativeTable
    code: CodeMemory
    variables: Variables
    stack: list[int]
    pc: int
    sp: int
    flags: int
    instructions: int
    extra_cost: int
    outbox: list[Message]

    def stop_on(self, fault: Fault) -> None:
        """Stop the event because of a fault."""


class _BadInstructionError(Exception):
    """The instruction cannot be executed; the argument is the reason."""


def step(machine: InterpretedMachine) -> int:
    """Execute one instruction.

    Returns:
        Its cost; 0 if it cannot be executed.

    Raises:
        Exception: Whatever a native raises, unchanged.
    """
    pc = machine.pc
    try:
        if not 0 <= pc < len(machine.code):
            raise _BadInstructionError("jump-out-of-range")
        word = machine.code.word(pc)
        machine.pc = _OPERATIONS[word >> 12](machine, word)
    except _BadInstructionError as bad:
        machine.stop_on(BadCode(pc, str(bad)))
        return 0
    finally:
        cost, machine.extra_cost = 1 + machine.extra_cost, 0
    machine.instructions += cost
    return cost


def _need(machine: InterpretedMachine, count: int) -> None:
    if machine.sp + 1 < count:
        raise _BadInstructionError("stack-underflow")


def _pop(machine: InterpretedMachine, count: int = 1) -> list[int]:
    """Remove words from the stack and return them, the topmost first."""
    _need(machine, count)
    words = machine.stack[machine.sp + 1 - count : machine.sp + 1][::-1]
    machine.sp -= count
    return words


def _push(machine: InterpretedMachine, value: int) -> None:
    _need_room(machine)
    machine.sp += 1
    machine.stack[machine.sp] = value


def _need_room(machine: InterpretedMachine) -> None:
    if machine.sp + 1 >= len(machine.stack):
        raise _BadInstructionError("stack-overflow")


def _variable(machine: InterpretedMachine, address: int) -> int:
    if address >= len(machine.variables):
        raise _BadInstructionError("variable-out-of-range")
    return address


def _target(machine: InterpretedMachine, address: int) -> int:
    if not 0 <= address < len(machine.code):
        raise _BadInstructionError("jump-out-of-range")
    return address


def _stop(machine: InterpretedMachine, _word: int) -> int:
    machine.flags &= ~ACTIVE
    return machine.pc


def _small_immediate(machine: InterpretedMachine, word: int) -> int:
    _push(machine, signed12(word))
    return machine.pc + 1


def _large_immediate(machine: InterpretedMachine, _word: int) -> int:
    _push(machine, signed(machine.code.word(machine.pc + 1)))
    return machine.pc + 2


def _load(machine: InterpretedMachine, word: int) -> int:
    _need_room(machine)
    _push(machine, machine.variables.words[_variable(machine, word & 0xFFF)])
    return machine.pc + 1


def _store(machine: InterpretedMachine, word: int) -> int:
    _need(machine, 1)
    address = _variable(machine, word & 0xFFF)
    (machine.variables.words[address],) = _pop(machine)
    return machine.pc + 1


def _load_indexed(machine: InterpretedMachine, word: int) -> int:
    size, index = machine.code.word(machine.pc + 1), _index(machine)
    if index >= size:
        machine.stop_on(OutOfBounds(machine.pc, size, index))
        return machine.pc
    machine.stack[machine.sp] = machine.variables.words[_variable(machine, (word & 0xFFF) + index)]
    return machine.pc + 2


def _store_indexed(machine: InterpretedMachine, word: int) -> int:
    size, index = machine.code.word(machine.pc + 1), _index(machine, 2)
    if index >= size:
        machine.stop_on(OutOfBounds(machine.pc, size, index))
        return machine.pc
    address = _variable(machine, (word & 0xFFF) + index)
    _, machine.variables.words[address] = _pop(machine, 2)
    return machine.pc + 2


def _index(machine: InterpretedMachine, needed: int = 1) -> int:
    """The topmost word, unsigned, which stays on the stack of at least `needed` words."""
    _need(machine, needed)
    return machine.stack[machine.sp] & 0xFFFF


def _unary(machine: InterpretedMachine, word: int) -> int:
    if word & 0xFFF >= len(UNARY_FUNCTIONS):
        raise _BadInstructionError("unknown-unary-operator")
    (value,) = _pop(machine)
    _push(machine, UNARY_FUNCTIONS[word & 0xFFF](value))
    return machine.pc + 1


def _binary(machine: InterpretedMachine, word: int) -> int:
    _push(machine, _result(machine, word & 0xFFF))
    return machine.pc + 1


def _result(machine: InterpretedMachine, operator: int) -> int:
    """Pop two words and return the result of an operator, 0 after a division by zero."""
    if operator >= len(BINARY_FUNCTIONS):
        raise _BadInstructionError("unknown-binary-operator")
    right, left = _pop(machine, 2)
    try:
        return BINARY_FUNCTIONS[operator](left, right)
    except ZeroDivisionError:
        machine.stop_on(DivisionByZero(machine.pc))
        return 0


def _jump(machine: InterpretedMachine, word: int) -> int:
    return _target(machine, machine.pc + signed12(word))


def _branch(machine: InterpretedMachine, word: int) -> int:
    """Continue if the condition is true, for a `when` only if it was not true before; otherwise jump."""
    code, pc = machine.code, machine.pc
    is_true = bool(_result(machine, word & 0xFF))
    if not machine.flags & ACTIVE:
        return pc + 2
    was_true, code.edges[pc] = code.edges[pc], int(is_true)
    if pc in code.overlapped:
        code.refresh(pc)
    if is_true and not (word & EDGE and was_true):
        return pc + 2
    return _target(machine, pc + signed(code.word(pc + 1)))


def _emit(machine: InterpretedMachine, word: int) -> int:
    address, count = machine.code.word(machine.pc + 1), machine.code.word(machine.pc + 2)
    if count > MAX_EMITTED:
        raise _BadInstructionError("emit-too-long")
    if address + count > len(machine.variables):
        raise _BadInstructionError("variable-out-of-range")
    machine.outbox.append(Emitted(word & 0xFFF, tuple(machine.variables[address : address + count])))
    machine.extra_cost = machine.costs.emit.of(count)
    return machine.pc + 3


def _native(machine: InterpretedMachine, word: int) -> int:
    number, pc = word & 0xFFF, machine.pc
    if number >= len(machine.natives):
        raise _BadInstructionError("unknown-native")
    popped = _pop(machine, machine.natives.count_popped(number))
    machine.extra_cost = machine.natives.cost(number, popped)
    try:
        is_possible = machine.natives.call(number, pc, popped)
    except BaseException:  # its arguments are popped: continue after the native
        machine.pc = pc + 1
        machine.instructions += 1 + machine.extra_cost
        raise
    if not is_possible:
        machine.extra_cost = 0
        raise _BadInstructionError("variable-out-of-range")
    return pc + 1


def _call(machine: InterpretedMachine, word: int) -> int:
    _push(machine, machine.pc + 1)
    return _target(machine, word & 0xFFF)


def _return(machine: InterpretedMachine, _word: int) -> int:
    _need(machine, 1)
    target = _target(machine, machine.stack[machine.sp])
    machine.sp -= 1
    return target


def _unknown(_machine: InterpretedMachine, _word: int) -> int:
    raise _BadInstructionError("unknown-instruction")


_OPERATIONS: Mapping[int, Callable[[InterpretedMachine, int], int]] = {
    Op.STOP: _stop,
    Op.PUSH: _small_immediate,
    Op.PUSHL: _large_immediate,
    Op.LOAD: _load,
    Op.STORE: _store,
    Op.LOADX: _load_indexed,
    Op.STOREX: _store_indexed,
    Op.UNARY: _unary,
    Op.BINARY: _binary,
    Op.JUMP: _jump,
    Op.BRANCH: _branch,
    Op.EMIT: _emit,
    Op.NATIVE: _native,
    Op.CALL: _call,
    Op.RET: _return,
    Op.UNKNOWN: _unknown,
}
