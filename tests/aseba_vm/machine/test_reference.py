"""The quick loop of the interpreter does what the reference does, instruction by instruction and over whole runs."""

from __future__ import annotations

import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from aseba_vm import NativeFault, VirtualMachine
from aseba_vm.bytecode import Op
from aseba_vm.jit.tiering import INTERPRETER
from aseba_vm.machine import reference
from aseba_vm.machine.costs import Cost, Costs
from aseba_vm.machine.interpreter import interpret
from aseba_vm.machine.reference import ACTIVE
from aseba_vm.target import NativeFunction, Parameter, TargetDescription, Variable
from aseba_vm.targets import THYMIO_II

SMALL = TargetDescription(
    "small",
    variables_size=24,
    bytecode_size=40,
    stack_size=4,
    variables=(Variable("_id", 1), Variable("event.source", 1), Variable("event.args", 4)),
    natives=(
        NativeFunction("refuse", (Parameter("value", 1),)),
        NativeFunction("charge", (Parameter("words", -1),)),
        NativeFunction("unknown", (Parameter("words", 3),)),
    ),
)
COSTS = Costs({"charge": Cost(3, 1)}, Cost(2), Cost(5, 1))

numbers = st.integers(-32768, 32767) | st.integers(-3, 40) | st.sampled_from((0, 1, -1, 32767, -32768))
limits = st.sampled_from((SMALL.variables_size, SMALL.variables_size - 1, SMALL.bytecode_size, SMALL.bytecode_size - 1))
operands = st.integers(0, 0xFFF) | st.integers(0, 50) | st.integers(0xFD0, 0xFFF) | limits
instructions = st.builds(lambda op, operand: op << 12 | operand, st.sampled_from(Op), operands)
branches = st.builds(lambda operator, flags: 0xA000 | operator | flags << 8, st.integers(0, 19), st.integers(0, 3))
words = instructions | branches | st.integers(0, 0xFFFF) | st.integers(0, 30)


def _refuse(call):
    if call.value(0) % 3 == 0:
        raise NativeFault("refused")


def _charge(call):
    call.charge(len(call.read(0)))


def _machine(code, memory, stack, pc):
    machine = VirtualMachine(SMALL, {"refuse": _refuse, "charge": _charge}, costs=COSTS, engine=INTERPRETER)
    machine.set_bytecode(code)
    machine.resume()
    machine.pop_messages()
    machine.write_variables(0, memory)
    machine.stack[: len(stack)] = stack
    machine.pc, machine.sp, machine.flags = pc, len(stack) - 1, ACTIVE
    return machine


def _state(machine):
    return (
        (machine.pc, machine.sp, machine.flags, machine.instructions, machine.extra_cost, machine.fault),
        machine.stack[: machine.sp + 1],
        list(machine.variables),
        machine.bytecode,
        machine.pop_messages(),
    )


@given(
    st.lists(words, min_size=1, max_size=40),
    st.lists(numbers, max_size=24),
    st.lists(numbers, max_size=4),
    st.integers(0, 40),
)
@settings(max_examples=1500, deadline=None)
def test_an_instruction_does_the_same(code, memory, stack, pc):
    quick, slow = (_machine(code, memory, stack, pc) for _ in range(2))
    for _ in range(4):
        assert interpret(quick, 1) == reference.step(slow)
        assert _state(quick) == _state(slow)
        if not quick.flags & ACTIVE:
            break


@given(st.sampled_from(Op), operands, st.lists(numbers, max_size=3), st.lists(numbers, min_size=1, max_size=4))
@settings(max_examples=1500, deadline=None)
def test_every_operation_does_the_same(op, operand, more, stack):
    code = [3, 0xFFFF, 3, op << 12 | operand, *(word & 0xFFFF for word in more)]
    quick, slow = (_machine(code, range(24), stack, 3) for _ in range(2))
    assert interpret(quick, 1) == reference.step(slow)
    assert _state(quick) == _state(slow)


@pytest.mark.parametrize("seed", range(40))
def test_a_run_of_random_words_does_the_same(seed):
    source = random.Random(seed)
    code = [
        3,
        0xFFFF,
        3,
        *(source.choice((0x1000, 0x3000, 0x4000, 0x8000, 0xA000)) | source.randrange(18) for _ in "x" * 30),
    ]
    quick, slow = (_machine(code, range(24), [], 3) for _ in range(2))
    spent = interpret(quick, 300)
    stepped = 0
    while stepped < 300 and slow.flags & ACTIVE:
        stepped += reference.step(slow)
    assert stepped == spent
    assert _state(quick) == _state(slow)


def test_a_native_that_raises_leaves_both_after_its_call():
    def fail(_call):
        raise LookupError("not here")

    states = []
    for execute in (lambda machine: interpret(machine, 1), reference.step):
        machine = VirtualMachine(THYMIO_II, {"_system.reboot": fail}, engine=INTERPRETER)
        machine.set_bytecode([3, 0xFFFF, 3, 0xC000])
        machine.resume()
        with pytest.raises(LookupError, match="not here"):
            execute(machine)
        states.append(_state(machine))
    assert states[0] == states[1]
