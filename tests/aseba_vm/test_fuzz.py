"""Any text compiles or has one error with a position; any words run, or stop the machine with a reason."""

from __future__ import annotations

import contextlib
import random

import pytest

from aseba_vm import AeslError, CompileError, VirtualMachine, aesl, compile, compile_stages
from aseba_vm.bytecode import disassemble
from aseba_vm.targets import THYMIO_II
from tests.aseba_vm.programs import Writer
from tests.aseba_vm.vectors import load
from tests.seeds import seeds

EVENTS = [("ping", 1), ("pair", 2), ("nothing", 0)]
CONSTANTS = [("N", 4)]
PLACELESS = {"stack-overflow", "bytecode-too-large"}


def _compiled(source):
    """Return the program, or None after checking the error."""
    try:
        return compile(source, THYMIO_II, EVENTS, CONSTANTS)
    except CompileError as error:
        refusal = error
    assert str(refusal)
    if refusal.kind not in PLACELESS:
        assert -1 <= refusal.pos.offset <= len(source)
        assert 0 <= refusal.pos.row <= source.count("\n")
    return None


@pytest.mark.parametrize("seed", seeds(8, landing=3))
def test_a_random_program_compiles_or_is_refused_in_place(seed):
    compiled = 0
    for number in range(60):
        source = Writer(1000 * seed + number).program()
        program = _compiled(source)
        if program is None:
            continue
        compiled += 1
        assert len(program.words) == len(program.lines)
        assert disassemble(program.words)
        _exercise(program.words, seed)
    assert compiled >= 10


def _exercise(words, seed):
    """Run events in a machine, which must never raise."""
    machine = VirtualMachine(THYMIO_II)
    machine.set_bytecode(words)
    source = random.Random(seed)
    for _ in range(6):
        machine.resume()
        machine.run(500)
        if source.random() < 0.5:
            machine.receive(source.randrange(3), 1, [source.randint(-32768, 32767)])
        else:
            machine.start_local(source.randrange(17))
    machine.run(500)
    assert all(-32768 <= value <= 32767 for value in machine.variables)


@pytest.mark.parametrize("seed", range(4))
def test_a_machine_survives_random_words(seed):
    source = random.Random(seed)
    for _ in range(40):
        words = [source.randrange(0x10000) for _ in range(source.randint(1, 200))]
        if source.random() < 0.7:
            words[:3] = [3, 0xFFFF, 3]
        disassemble(words)
        _exercise(words, source.randrange(1000))


@pytest.mark.parametrize("seed", range(4))
def test_a_machine_survives_damaged_programs(seed):
    source = random.Random(seed)
    for vector in source.sample(load("aseba-compile"), 40):
        if vector["target"] != "thymio2":
            continue
        words = list(vector["expect"]["bytecode"])
        for _ in range(3):
            words[source.randrange(len(words))] = source.randrange(0x10000)
        _exercise(words, seed)


@pytest.mark.parametrize("seed", range(4))
def test_damaged_sources_are_refused_in_place(seed):
    source = random.Random(seed)
    for vector in source.sample(load("aseba-compile"), 60):
        text = vector["source"]
        for _ in range(3):
            at, length = source.randint(0, len(text)), source.randint(0, 5)
            extra = "".join(source.choice("()[]:,=+-*/ \n\t#*\0x0aé²if end") for _ in range(source.randint(0, 4)))
            text = text[:at] + extra + text[at + length :]
        _compiled(text)


@pytest.mark.parametrize("seed", range(2))
def test_damaged_files_are_read_or_refused(seed):
    source = random.Random(seed)
    for vector in load("aseba-aesl"):
        for _ in range(5):
            text = vector["file"]
            at = source.randint(0, len(text))
            text = text[:at] + source.choice(("<", ">", "&", '"', "\0", "<a>", "]]>", "")) + text[at + 1 :]
            with contextlib.suppress(AeslError):
                assert aesl.dumps(aesl.loads(text)) == text


@pytest.mark.parametrize("stage", ["tokens", "tree", "expanded", "optimized", "code"])
def test_every_stage_of_a_deep_program_can_be_shown(stage):
    source = f"var a\na = {'(' * 3000}a + {'-' * 0}1{')' * 3000}\n{'if a == 1 then ' * 1500}{'end ' * 1500}"
    assert compile_stages(source, THYMIO_II).dump(stage)
