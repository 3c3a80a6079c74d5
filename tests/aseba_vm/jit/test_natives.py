"""A native has the same results in every engine: any address, any size, overlapping arguments, extreme words."""

from __future__ import annotations

import random

import pytest

from aseba_vm import VirtualMachine, compile
from aseba_vm.jit.tiering import INTERPRETER
from aseba_vm.machine.costs import Cost, Costs
from aseba_vm.machine.machine_messages import BadCode
from aseba_vm.machine.natives import NATIVES
from aseba_vm.targets import THYMIO_II
from tests.aseba_vm.engines import AVAILABLE, TRANSLATORS

pytestmark = pytest.mark.usefixtures("translators_work")

LIMITS = (0, 1, -1, 2, 127, 128, 16383, 16384, 16385, -16384, -16385, 32767, -32767, -32768)
COSTS = Costs(others=Cost(7, 1))
STOP, PUSH, NATIVE = 0, 0x1000, 0xC000


def _call(number, source):
    """Return words that call a native with arguments in a small part of memory."""
    native = THYMIO_II.natives[number]
    sizes = {}
    for index in native.free_sizes:
        key = native.parameters[index].size
        sizes[key] = source.choice((0, 1, 2, 3, 5, 8, 16, 17, 30, 40))
    addresses = [200 + source.randrange(60) for _ in native.parameters]
    popped = addresses + [sizes[native.parameters[index].size] for index in native.free_sizes]
    return [*(PUSH | word for word in reversed(popped)), NATIVE | number]


def _word(source):
    return source.choice((source.choice(LIMITS), source.randint(-9, 9), source.randint(-32768, 32767)))


@pytest.mark.parametrize("engine", TRANSLATORS)
@pytest.mark.parametrize("name", sorted(NATIVES))
def test_a_native_does_the_same_in_every_engine(name, engine):
    number = [native.name for native in THYMIO_II.natives].index(name)
    source = random.Random(name)
    for _ in range(40):
        words = [3, 0xFFFF, 3, *_call(number, source), STOP]
        machines = [VirtualMachine(THYMIO_II, engine=each, costs=COSTS) for each in (INTERPRETER, engine)]
        for machine in machines:
            machine.set_bytecode(words)
        for _ in range(4):
            memory = [_word(source) for _ in range(140)]
            if name.startswith("deque"):
                place = words[-3] & 0xFFF
                nonsense = source.choice((6, 6, 6, 0x7FFF))
                memory[place - 180 : place - 178] = [source.randrange(6), source.randrange(nonsense)]
            for machine in machines:
                machine.write_variables(180, memory)
                machine.resume()
                machine.setup(0xFFFF)
                machine.run()
            plain, translated = machines
            assert not isinstance(plain.fault, BadCode)
            assert plain.variables == translated.variables
            assert (plain.pc, plain.flags, plain.fault, plain.instructions, plain.random_state) == (
                translated.pc,
                translated.flags,
                translated.fault,
                translated.instructions,
                translated.random_state,
            )
            assert plain.pop_messages() == translated.pop_messages()


@pytest.mark.parametrize("engine", AVAILABLE)
def test_moves_round_and_round_a_deque_are_charged(engine):
    text = "var q[10]\nvar n\nvar k\nwhile k == 0 do\nq[0] = 0\nq[1] = {start}\ncall deque.insert(q, n, 3)\nend"
    spent = {}
    for start in (0, -1):
        machine = VirtualMachine(THYMIO_II, engine=engine, costs=COSTS)
        machine.load(compile(text.format(start=start), THYMIO_II))
        machine.run(100)
        spent[start] = machine.instructions
    assert spent[0] < 200
    assert 2 * 65000 < spent[-1] < 2 * 66000
