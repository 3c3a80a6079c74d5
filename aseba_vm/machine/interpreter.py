"""The interpreter: one loop over decoded operations.

Source: docs/spec/aseba-bytecode-vm.md sections 7 to 10.3.

The loop reads operations with decoded operands (:mod:`aseba_vm.machine.code_memory`). It is written for speed: stack
checks are inline, and reads beyond a list raise IndexError, which the end of the function turns into a fault, instead
of being checked in advance. :mod:`aseba_vm.machine.reference` defines the same, one function per operation.
"""

from __future__ import annotations

from typing import Protocol

from aseba_vm.bytecode import MAX_EMITTED
from aseba_vm.machine.code_memory import CodeMemory
from aseba_vm.machine.costs import Costs
from aseba_vm.machine.data_memory import Variables
from aseba_vm.machine.machine_messages import BadCode, DivisionByZero, Emitted, Fault, Message, OutOfBounds
from aseba_vm.machine.native_table import NativeTable
from aseba_vm.machine.operations import (
    BAD,
    BINARY,
    BRANCHES,
    CALL,
    EMIT,
    IF,
    JUMP,
    LOAD,
    LOADX,
    NATIVE,
    PUSH,
    RET,
    STOP,
    STORE,
    STOREX,
    UNARY,
)
from aseba_vm.target import TargetDescription

ACTIVE = 1
"""Flag of a machine that is executing an event."""


class InterpretedMachine(Protocol):
    """What the loop needs of a machine."""

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


def interpret(machine: InterpretedMachine, limit: int) -> int:
    """Execute instructions while the event is active and less than ``limit`` is spent; return the budget used.

    Each instruction costs one, natives and events also their own cost, so the last operation may exceed the limit.
    """
    spent = _run_slice(machine, limit)
    while spent < limit and machine.flags & ACTIVE:
        spent += _run_slice(machine, limit - spent)
    return spent


def _run_slice(machine: InterpretedMachine, limit: int) -> int:
    """Execute until ``limit`` is spent, the event ends, or an operation costs more than its instruction."""
    code, variables, stack = machine.code, machine.variables.words, machine.stack
    operations, edges, size = code.operations, code.edges, len(code)
    pc, sp = machine.pc, machine.sp
    executed = 0
    kind = BAD
    try:
        for executed in range(limit):  # also read after the loop, where it is the number of complete instructions
            kind, first, second = operations[pc]
            if kind == LOAD:
                stack[sp + 1] = variables[first]
                sp += 1
                pc += 1
            elif kind == PUSH:
                stack[sp + 1] = first
                sp += 1
                pc += second
            elif kind == STORE:
                if sp < 0:
                    return _stop_on_bad_code(machine, pc, sp, executed, "stack-underflow")
                variables[first] = stack[sp]
                sp -= 1
                pc += 1
            elif kind == BINARY:
                if sp < 1:
                    return _stop_on_bad_code(machine, pc, sp, executed, "stack-underflow")
                right = stack[sp]
                sp -= 1
                stack[sp] = first(stack[sp], right)
                pc += 1
            elif kind in BRANCHES:
                if sp < 1:
                    return _stop_on_bad_code(machine, pc, sp, executed, "stack-underflow")
                sp -= 2
                is_true = 1 if first(stack[sp + 1], stack[sp + 2]) else 0
                was_true = edges[pc]
                if is_true != was_true:
                    edges[pc] = is_true
                    if pc in code.overlapped:
                        code.refresh(pc)
                if is_true and (kind == IF or not was_true):
                    pc += 2
                else:
                    pc += second
                    if not 0 <= pc < size:
                        return _stop_on_bad_code(machine, pc - second, sp, executed, "jump-out-of-range")
            elif kind == JUMP:
                pc += first
                if not 0 <= pc < size:
                    return _stop_on_bad_code(machine, pc - first, sp, executed, "jump-out-of-range")
            elif kind == LOADX:
                if sp < 0:
                    return _stop_on_bad_code(machine, pc, sp, executed, "stack-underflow")
                index = stack[sp] & 0xFFFF
                if index >= second:
                    machine.stop_on(OutOfBounds(pc, second, index))
                    break
                stack[sp] = variables[first + index]
                pc += 2
            elif kind == STOREX:
                if sp < 1:
                    return _stop_on_bad_code(machine, pc, sp, executed, "stack-underflow")
                index = stack[sp] & 0xFFFF
                if index >= second:
                    machine.stop_on(OutOfBounds(pc, second, index))
                    break
                variables[first + index] = stack[sp - 1]
                sp -= 2
                pc += 2
            elif kind == UNARY:
                if sp < 0:
                    return _stop_on_bad_code(machine, pc, sp, executed, "stack-underflow")
                stack[sp] = first(stack[sp])
                pc += 1
            elif kind == STOP:
                machine.flags &= ~ACTIVE
                break
            elif kind == CALL:
                stack[sp + 1] = pc + 1
                sp += 1
                if first >= size:
                    return _stop_on_bad_code(machine, pc, sp, executed, "jump-out-of-range")
                pc = first
            elif kind == RET:
                if sp < 0:
                    return _stop_on_bad_code(machine, pc, sp, executed, "stack-underflow")
                if not 0 <= stack[sp] < size:
                    return _stop_on_bad_code(machine, pc, sp, executed, "jump-out-of-range")
                pc = stack[sp]
                sp -= 1
            elif kind == EMIT:
                address, count = second
                if count > MAX_EMITTED:
                    return _stop_on_bad_code(machine, pc, sp, executed, "emit-too-long")
                if address + count > len(variables):
                    return _stop_on_bad_code(machine, pc, sp, executed, "variable-out-of-range")
                machine.outbox.append(Emitted(first, tuple(variables[address : address + count])))
                pc += 3
                cost = machine.costs.emit.of(count)
                if cost:
                    executed += cost
                    break
            elif kind == NATIVE:
                try:
                    reason, sp = _call(machine, first, pc, sp)
                except BaseException:  # its arguments are popped: continue after the native
                    machine.pc, machine.sp = pc + 1, sp - machine.natives.count_popped(first)
                    machine.instructions += executed + 1 + machine.extra_cost
                    machine.extra_cost = 0
                    raise
                if reason:
                    return _stop_on_bad_code(machine, pc, sp, executed, reason)
                pc += 1
                if machine.extra_cost:
                    executed += machine.extra_cost
                    machine.extra_cost = 0
                    break
                if not machine.flags & ACTIVE:
                    break
            else:
                return _stop_on_bad_code(machine, pc, sp, executed, first)
    except ZeroDivisionError:
        machine.stop_on(DivisionByZero(pc))
        if kind == BINARY:
            stack[sp] = 0
            pc += 1
        else:
            pc += 2
    except IndexError:
        if not 0 <= pc < size:
            return _stop_on_bad_code(machine, pc, sp, executed, "jump-out-of-range")
        is_full = sp + 1 >= len(stack) and kind in (LOAD, PUSH, CALL)
        return _stop_on_bad_code(machine, pc, sp, executed, "stack-overflow" if is_full else "variable-out-of-range")
    machine.pc, machine.sp = pc, sp
    executed += 1
    machine.instructions += executed
    return executed


def _call(machine: InterpretedMachine, number: int, pc: int, sp: int) -> tuple[str, int]:
    """Call a native; return the reason if that was impossible (empty otherwise), and the new stack index."""
    if number >= len(machine.natives):
        return "unknown-native", sp
    count = machine.natives.count_popped(number)
    if sp + 1 < count:
        return "stack-underflow", sp
    popped = machine.stack[sp - count + 1 : sp + 1][::-1]
    machine.extra_cost = machine.natives.cost(number, popped)
    if machine.natives.call(number, pc, popped):
        return "", sp - count
    machine.extra_cost = 0
    return "variable-out-of-range", sp - count


def _stop_on_bad_code(machine: InterpretedMachine, pc: int, sp: int, executed: int, reason: str) -> int:
    machine.pc, machine.sp = pc, sp
    machine.instructions += executed
    machine.stop_on(BadCode(pc, reason))
    return executed
