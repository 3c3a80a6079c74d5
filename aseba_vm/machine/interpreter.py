"""The interpreter: a quick loop over decoded operations.

Source: docs/spec/aseba-bytecode-vm.md sections 7 to 10.3.

The loop executes what nearly every program consists of. An instruction that it cannot execute, because it fails or is
rare, is left to `aseba_vm.machine.reference.step` before it has changed anything.
"""

from __future__ import annotations

from aseba_vm.machine.operations import (
    BINARY,
    BRANCHES,
    CALL,
    IF,
    JUMP,
    LOAD,
    LOADX,
    PUSH,
    RET,
    STORE,
    STOREX,
    UNARY,
)
from aseba_vm.machine.reference import ACTIVE, InterpretedMachine, step


def interpret(machine: InterpretedMachine, limit: int) -> int:
    """Execute instructions while the event is active and less than `limit` is spent.

    Each instruction costs one, natives and events also their own cost, so the last operation may exceed the limit.

    Returns:
        The budget used.
    """
    spent = 0
    while spent < limit and machine.flags & ACTIVE:
        spent += _run_slice(machine, limit - spent)
        if spent < limit:
            spent += step(machine)
    return spent


def _run_slice(machine: InterpretedMachine, limit: int) -> int:
    """Execute up to `limit` instructions, or up to one that the loop does not execute, and return their number."""
    code, variables, stack = machine.code, machine.variables.words, machine.stack
    operations, edges, size = code.operations, code.edges, len(code)
    pc, sp = machine.pc, machine.sp
    executed = 0
    try:
        for executed in range(limit):  # noqa: B007  # read after the loop: the number of complete instructions
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
                    break
                variables[first] = stack[sp]
                sp -= 1
                pc += 1
            elif kind == BINARY:
                if sp < 1:
                    break
                stack[sp - 1] = first(stack[sp - 1], stack[sp])
                sp -= 1
                pc += 1
            elif kind in BRANCHES:
                if sp < 1:
                    break
                is_true = 1 if first(stack[sp - 1], stack[sp]) else 0
                was_true = edges[pc]
                target = pc + (2 if is_true and (kind == IF or not was_true) else second)
                if not 0 <= target < size:
                    break
                if is_true != was_true:
                    edges[pc] = is_true
                    if pc in code.overlapped:
                        code.refresh(pc)
                sp -= 2
                pc = target
            elif kind == JUMP:
                target = pc + first
                if not 0 <= target < size:
                    break
                pc = target
            elif kind == LOADX:
                if sp < 0:
                    break
                index = stack[sp] & 0xFFFF
                if index >= second:
                    break
                stack[sp] = variables[first + index]
                pc += 2
            elif kind == STOREX:
                if sp < 1:
                    break
                index = stack[sp] & 0xFFFF
                if index >= second:
                    break
                variables[first + index] = stack[sp - 1]
                sp -= 2
                pc += 2
            elif kind == UNARY:
                if sp < 0:
                    break
                stack[sp] = first(stack[sp])
                pc += 1
            elif kind == CALL:
                if first >= size:
                    break
                stack[sp + 1] = pc + 1
                sp += 1
                pc = first
            elif kind == RET:
                if sp < 0 or not 0 <= stack[sp] < size:
                    break
                pc = stack[sp]
                sp -= 1
            else:
                break
        else:
            executed = limit
    except (IndexError, ZeroDivisionError):  # before the instruction has changed anything
        pass
    machine.pc, machine.sp = pc, sp
    machine.instructions += executed
    return executed
