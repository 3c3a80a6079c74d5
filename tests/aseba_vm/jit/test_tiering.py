"""Every engine leaves the machine in the same state."""

from __future__ import annotations

import gc
import random
import signal
import subprocess
import sys
import weakref
from contextlib import suppress
from functools import cache

import pytest

from aseba_vm import CompileError, VirtualMachine, compile
from aseba_vm.bytecode import Op
from aseba_vm.jit import tiering, wasm_backend
from aseba_vm.jit.tiering import INTERPRETER, WASM
from aseba_vm.kernel.wasm_runtime import is_usable
from aseba_vm.machine.costs import NO_COSTS, Cost, Costs
from aseba_vm.targets import THYMIO_II
from tests.aseba_vm.engines import AVAILABLE, TRANSLATORS
from tests.aseba_vm.programs import Writer
from tests.aseba_vm.vectors import load
from tests.seeds import seeds

pytestmark = pytest.mark.usefixtures("translators_work")

EVENTS = [("ping", 1), ("pair", 2), ("nothing", 0)]


def _state(machine):
    return (
        machine.pc,
        machine.flags,
        machine.stack[: machine.sp + 1],
        machine.variables.words[:],
        machine.code.edges[:],
        machine.instructions,
        machine.random_state,
        machine.fault,
        machine.pop_messages(),
    )


COSTS = Costs(
    {"math.copy": Cost(3, 1), "math.fill": Cost(0, 2), "leds.top": Cost(40), "leds.rc": Cost(700), "math.rand": Cost()},
    Cost(5, 1),
    Cost(20, 3),
)


def _light(call):
    """A native whose cost depends on its argument."""
    call.charge(call.value(0) % 7 * 10)


def _compare(words, seed, engines, costs=(NO_COSTS, COSTS)):
    """Run the same events in two machines, one of which changes engines, and compare them after each."""
    for each in costs:
        _compare_at(each, words, seed, engines)


def _compare_at(costs, words, seed, engines):
    machines = [
        VirtualMachine(THYMIO_II, {"leds.top": _light}, costs=costs, engine=engine)
        for engine in (INTERPRETER, engines[0])
    ]
    source = random.Random(seed)
    current = engines[0]
    for machine in machines:
        machine.set_bytecode(words)
    for _ in range(source.randint(3, 25)):
        limit = source.choice((1, 3, 10, 50, 300, 300, 1000, 3000))
        choice = source.randrange(14)
        event, value = source.randrange(3), source.choice((0, 1, 3, -1, 32767, -32768, source.randint(-99, 99)))
        address, local = source.randrange(128, 170), source.randrange(17)
        engine = source.choice(engines)
        for machine in machines:
            if choice == 0:
                machine.reset()
            elif choice == 1:
                machine.step()
            elif choice == 2:
                machine.write_variables(address, [value])
            elif choice < 6:
                machine.receive(event, 1, [value])
            elif choice < 10:
                machine.start_local(local)
            elif choice == 12 and machine.code.words:
                machine.set_breakpoint(address % len(machine.code.words))
            elif choice == 13:
                machine.clear_breakpoints()
            if choice != 1:
                machine.resume()
            machine.run(limit)
        if engine != current:
            machines[1].use_engine(engine)
            current = engine
        assert _state(machines[0]) == _state(machines[1])
    assert machines[0].bytecode == machines[1].bytecode


@pytest.mark.parametrize("engines", [*([name] for name in TRANSLATORS), AVAILABLE], ids="-".join)
@pytest.mark.parametrize("seed", seeds(6, landing=2))
def test_random_programs_end_in_the_same_state(seed, engines):
    programs = _random_programs(seed)
    assert len(programs) >= 10
    for number, words in programs.items():
        _compare(words, number, engines)


@cache
def _random_programs(seed):
    """Return the words of the correct ones of 60 programs, by their numbers."""
    programs = {}
    for number in range(60):
        with suppress(CompileError):
            program = compile(Writer(7000 * seed + number).program(), THYMIO_II, EVENTS, [("N", 4)])
            programs[number] = program.words
    return programs


@pytest.mark.parametrize("engines", [*([name] for name in TRANSLATORS), AVAILABLE], ids="-".join)
@pytest.mark.parametrize("seed", seeds(4, landing=2))
def test_damaged_programs_end_in_the_same_state(seed, engines):
    source = random.Random(seed)
    for vector in source.sample(load("aseba-compile"), 100):
        words = list(vector["expect"]["bytecode"])
        if vector["target"] == "thymio2" and len(words) > 1:
            for _ in range(source.randint(1, 4)):
                words[source.randrange(len(words))] = _likely_word(source)
            _compare(words, seed, engines)


@pytest.mark.parametrize("engines", [*([name] for name in TRANSLATORS), AVAILABLE], ids="-".join)
@pytest.mark.parametrize("seed", seeds(4, landing=2))
def test_random_words_end_in_the_same_state(seed, engines):
    source = random.Random(seed)
    for _ in range(60):
        words = [_likely_word(source) for _ in range(source.randint(3, 120))]
        words[:3] = [3, 0xFFFF, 3]
        _compare(words, source.randrange(1000), engines)


def _likely_word(source):
    """Return a word, usually a valid instruction."""
    match source.randrange(10):
        case 0 | 1:
            return 0x1000 | source.randrange(16)
        case 2 | 3:
            return source.choice((0x3000, 0x4000)) | source.randrange(128, 136)
        case 4:
            return 0x8000 | source.randrange(18)
        case 5:
            return source.choice((0x9000 | source.randrange(8), 0x9FF0 | source.randrange(16)))
        case 6:
            return source.choice((0xA00A, 0xA10C, 0xA30B, 0xA211))
        case 7:
            return source.choice(
                (0xD000 | source.randrange(60), 0xE000, 0x7000 | source.randrange(3), 0, 0xC000, 0xB001)
            )
        case 8:
            return source.randrange(12)
    return source.randrange(0x10000)


NATIVE_CALLS = (
    "math.copy(t[1:4], t[0:3])",
    "math.fill(t, x)",
    "math.fill(t[0:2], t[1])",
    "math.addscalar(t[2:5], t[0:3], x)",
    "math.add(t[1:4], t[0:3], t[2:5])",
    "math.sub(t, u, t)",
    "math.mul(t, u, t)",
    "math.min(t, u, t)",
    "math.max(t, u, t)",
    "math.clamp(t, t, u, v)",
    "math.dot(x, t, u, 33)",
    "math.dot(x, t, u, 3)",
    "math.dot(x, t, u, y)",
    "math.muldiv(t, t, u, v)",
    "math.div(t, u, v)",
    "math.stat(t, x, y, z)",
    "math.rand(t)",
    "math.sqrt(x, y)",
    "math.rot2(t[0:1], u[1:2], x)",
    "deque.push_back(t, x)",
    "deque.pop_front(t, y)",
    "leds.top(x, y, z)",
    "math.copy(x, t[y & 3])",
)


@pytest.mark.parametrize("engine", TRANSLATORS)
@pytest.mark.parametrize("call", NATIVE_CALLS)
def test_natives_do_the_same(call, engine):
    head = "var x = -3\nvar y = 2\nvar z\nvar t[6] = [1, -2, 30000, -32768, 5, 7]\nvar u[6] = [9, 8, -7, 32767, 0, 1]\n"
    body = (
        f"var v[6] = [1, -1, 3, 0, 32767, 2]\nonevent ping\nx = event.args[0]\nt[y & 3] = x\ncall {call}\ny++\nx = t[2]"
    )
    program = compile(head + body, THYMIO_II, EVENTS)
    for seed in range(12):
        _compare(program.words, seed, [engine])


def _states_around_a_failing_native(engine):
    def fail(call):
        if call.value(0) == 3:
            raise LookupError("not in this simulator")

    source = "var n\nonevent ping\nwhen n > 1 do\nemit nothing\nend\nn++\ncall leds.rc(n)\nn = n + 10"
    machine = VirtualMachine(THYMIO_II, {"leds.rc": fail}, engine=engine)
    machine.load(compile(source, THYMIO_II, EVENTS))
    machine.run()
    for _ in range(3):
        machine.variables[128] %= 10
        machine.receive(0, 1, [])
        if machine.variables[128] != 2:
            machine.run()
    with pytest.raises(LookupError, match="not in this simulator"):
        machine.run()
    yield _state(machine)
    assert machine.bytecode[machine.pc - 1] >> 12 == Op.NATIVE
    machine.run()
    yield _state(machine)


@pytest.mark.parametrize("engine", TRANSLATORS)
def test_a_native_that_raises_leaves_the_machine_after_its_call(engine):
    assert list(_states_around_a_failing_native(engine)) == list(_states_around_a_failing_native(INTERPRETER))


ENDLESS = {
    "emit": "while k == 0 do\ni++\nemit pair [i, k]\nend",
    "native": "while k == 0 do\ni++\ncall leds.rc(i)\nend",
    "vector": "while k == 0 do\ni++\ncall math.fill(t, i)\nend",
    "own cost": "while k == 0 do\ni = (i + 1) % 30000\ncall leds.top(i, i, i)\nend",
    "subroutine": "while k == 0 do\ncallsub go\nend\nsub go\ni++\nemit ping i\ncall math.copy(t[0:3], t[4:7])",
}


@pytest.mark.parametrize("engine", AVAILABLE)
@pytest.mark.parametrize("program", ENDLESS)
def test_calls_and_events_are_charged_and_every_engine_stops_at_the_same_place(engine, program):
    compiled = compile(f"var i\nvar k\nvar t[40]\n{ENDLESS[program]}", THYMIO_II, EVENTS)
    machines = [
        VirtualMachine(THYMIO_II, {"leds.top": _light}, costs=COSTS, engine=each) for each in (INTERPRETER, engine)
    ]
    for machine in machines:
        machine.load(compiled)
    for limit in (1, 10, 777, 5000, 5000, 5000, 5000):
        before = machines[0].instructions
        for machine in machines:
            machine.run(limit)
        assert limit <= machines[0].instructions - before < limit + 710
        assert _state(machines[0]) == _state(machines[1])
    plain = VirtualMachine(THYMIO_II, engine=engine)
    plain.load(compiled)
    plain.run(machines[0].instructions)
    assert plain.variables[128] > 1.5 * machines[0].variables[128] > 1


@pytest.mark.parametrize("engine", AVAILABLE)
def test_a_program_without_an_end_can_be_interrupted(engine):
    def stop(_number, _frame):
        raise TimeoutError

    machine = VirtualMachine(THYMIO_II, engine=engine)
    machine.load(compile("var n\nwhile n == n do\nn++\nend", THYMIO_II))
    old = signal.signal(signal.SIGALRM, stop)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        with pytest.raises(TimeoutError):
            machine.run()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, old)


def _step_through(machine):
    machine.pause()
    machine.receive(0, 1, [])
    while machine.is_active:
        machine.step()
    machine.resume()


def _run_with_a_breakpoint(machine):
    machine.set_breakpoint(1000)
    machine.receive(0, 1, [])
    machine.run(1000)
    machine.clear_breakpoints()


def _run_traced(machine):
    machine.tracer = lambda pc: None
    machine.receive(0, 1, [])
    machine.run(1000)
    machine.tracer = None


@pytest.mark.parametrize("watched", [_step_through, _run_with_a_breakpoint, _run_traced])
@pytest.mark.parametrize("engine", AVAILABLE)
def test_edge_flags_of_a_watched_run_are_kept(engine, watched):
    program = compile("var a\nvar n\nonevent ping\nwhen a == 1 do\nn += 1\nend", THYMIO_II, [("ping", 0)])
    address, counter = program.addresses["a"][0], program.addresses["n"][0]
    machine = VirtualMachine(THYMIO_II, engine=engine)
    machine.load(program)
    machine.run(1000)
    for value in (0, 0, 0, 0, 0, 1, 1, 1):
        is_new = machine.variables[address] != value
        machine.variables[address] = value
        if is_new:
            watched(machine)
        else:
            machine.receive(0, 1, [])
            machine.run(1000)
    assert machine.variables[counter] == 1


@pytest.mark.skipif(WASM not in TRANSLATORS, reason="no wasmtime here")
def test_a_machine_frees_the_translated_code_of_the_program_before():
    """A store has the code of all its instances until it is freed itself; 20 kB for each program were kept."""
    machine = VirtualMachine(THYMIO_II, engine=WASM)
    stores = []
    for value in (5, 6, 7):
        machine.load(compile(f"var a = {value}", THYMIO_II))
        machine.run(100)
        assert machine.variables[THYMIO_II.variables_end] == value
        gc.collect()
        assert [store() for store in stores] == [None] * len(stores)
        stores.append(weakref.ref(machine._tiering._host._store))


def test_an_unknown_engine_is_rejected():
    with pytest.raises(ValueError, match="expected one of"):
        VirtualMachine(THYMIO_II, engine="steam")


def test_webassembly_by_name_needs_its_package(monkeypatch):
    monkeypatch.setattr(tiering, "is_usable", lambda: False)
    with pytest.raises(ValueError, match="needs the package wasmtime, which does not work here"):
        VirtualMachine(THYMIO_II, engine=WASM)


@pytest.mark.skipif(not is_usable(), reason="wasmtime is not installed")
def test_a_machine_without_memory_for_webassembly_interprets_and_logs_it_once(monkeypatch, caplog):
    def fail(*_arguments):
        raise MemoryError

    monkeypatch.setattr(tiering, "WasmHost", fail)
    machine = VirtualMachine(THYMIO_II)
    for _ in range(2):
        machine.load(compile("var n = 0\nwhile n < 9000 do\nn = n + 3\nend", THYMIO_II))
        machine.run()
        assert machine.variables[128] == 9000
    assert caplog.text.count("no memory for WebAssembly, programs are interpreted") == 1


@pytest.mark.skipif(not is_usable(), reason="wasmtime is not installed")
def test_a_translator_that_fails_leaves_the_program_to_the_interpreter(monkeypatch, caplog):
    def broken(*_arguments):
        raise RuntimeError("this cannot be translated")

    monkeypatch.setattr(wasm_backend, "translate", broken)
    program = compile("var n = 0\nwhile n < 1000 do\nn = n + 6 - 3\nend", THYMIO_II)
    machine = VirtualMachine(THYMIO_II, engine=WASM)
    machine.load(program)
    machine.run()
    address, _ = program.addresses["n"]
    assert machine.variables[address] == 1002
    assert "interpreting it" in caplog.text
    caplog.clear()


@pytest.mark.process
@pytest.mark.skipif(not is_usable(), reason="wasmtime is not installed")
def test_a_process_with_translated_programs_ends_in_silence():
    script = (
        "from aseba_vm import VirtualMachine, compile\n"
        "from aseba_vm.targets import THYMIO_II\n"
        "machine = VirtualMachine(THYMIO_II, engine='wasm')\n"
        "machine.load(compile('var n = 0\\nwhile n < 1000 do\\nn = n + 3\\nend', THYMIO_II))\n"
        "machine.run()\n"
    )
    ended = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=120, check=False)
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, "", "")
