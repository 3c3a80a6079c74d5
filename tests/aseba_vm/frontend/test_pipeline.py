"""The examples of docs/spec/aseba-bytecode-vm.md section 15, and the mapping between rows and words."""

import pytest

from aseba_vm import CompileError, compile, compile_stages
from aseba_vm.frontend.pipeline import assemble
from aseba_vm.targets import THYMIO_II

EXAMPLES = {
    "an element": (
        "var t[4] var i t[i + 1] = t[i] + 3000",
        "3 FFFF 3 3084 5080 4 2000 BB8 8002 3084 1001 8002 6080 4 0",
    ),
    "events by number": (
        "var n n = 1 onevent tap n = n + 1 onevent ping n = event.args[0] onevent prox",
        "7 0 7 FFF6 A FFFF F 3002 4080 0 3080 1001 8002 4080 0 1001 4080 0",
    ),
    "if else": (
        "var a if a == 1 then a = 2 else a = 3 end",
        "3 FFFF 3 3080 1001 A00A 5 1002 4080 9003 1003 4080 0",
    ),
    "if and": (
        "var a if a > 1 and a < 5 then a = 2 end",
        "3 FFFF 3 3080 1001 800C 3080 1005 800E A011 4 1002 4080 0",
    ),
    "when": ("var a when a > 1 do a = 2 end", "3 FFFF 3 3080 1001 A10C 4 1002 4080 0"),
    "while": (
        "var a while a < 5 do a = a + 1 end",
        "3 FFFF 3 3080 1005 A00E 7 3080 1001 8002 4080 9FF8 0",
    ),
    "for": (
        "var i var s for i in 1:3 do s = s + i end",
        "3 FFFF 3 1001 4080 3080 1003 A00F B 3081 3080 8002 4081 3080 1001 8002 4080 9FF4 0",
    ),
    "a vector through temporary words": (
        "var t[2] var u[2] t = t + u",
        "3 FFFF 3 3080 3082 8002 427E 3081 3083 8002 427F 327E 4080 327F 4081 0",
    ),
    "emit a variable": ("var a emit ping a", "3 FFFF 3 B000 80 1 0"),
    "emit a sum": ("var a emit ping a + 1", "3 FFFF 3 3080 1001 8002 427F B000 27F 1 0"),
    "a native": ("var v[3] call math.fill(v, 7)", "3 FFFF 3 1003 1007 427F 127F 1080 C005 0"),
    "a native with an element": (
        "var v[3] var i call math.fill(v, v[i])",
        "3 FFFF 3 1003 3083 427F 327F 327F 5080 3 427F 1080 8002 1080 C005 0",
    ),
    "a subroutine that runs on": (
        "var a callsub s sub s a = 1 if a == 2 then return end sub t a = 5",
        "3 FFFF 3 D005 0 1001 4080 3080 1002 A00A 3 E000 1005 4080 E000",
    ),
    "nothing": ("", "1"),
}


@pytest.mark.parametrize("name", EXAMPLES)
def test_the_examples_of_the_specification(name):
    source, words = EXAMPLES[name]
    program = compile(source, THYMIO_II, events=[("ping", 1)])
    assert [f"{word:X}" for word in program.words] == words.split()


PROGRAM = compile(
    "var n = 1\nvar m\n\nonevent ping\nn = n + 1\ncallsub s\nsub s\nm = n", THYMIO_II, events=[("ping", 1)]
)


def test_a_word_knows_its_row():
    assert [PROGRAM.row_of(pc) for pc in range(len(PROGRAM.words))][5:] == [4, 4, 4, 4, 5, 5, 0, 0, 0, 7, 7, 7]


def test_addresses_outside_the_code_have_no_row():
    assert PROGRAM.row_of(0) is None
    assert PROGRAM.row_of(-1) is None
    assert PROGRAM.row_of(99) is None


def test_a_row_knows_its_instructions():
    assert PROGRAM.addresses_of(4) == (5, 6, 7, 8)
    assert PROGRAM.addresses_of(2) == ()


def test_an_address_knows_its_event_or_subroutine():
    assert PROGRAM.segment_of(6).name == "ping"
    assert PROGRAM.segment_of(12).name == ""
    assert PROGRAM.segment_of(15).name == "s"
    assert PROGRAM.segment_of(2) is None
    assert PROGRAM.segment_of(500) is None


def test_a_variable_knows_its_address():
    assert PROGRAM.addresses == {"n": (128, 1), "m": (129, 1)}
    assert THYMIO_II.addresses["event.args"] == (2, 32)


def test_every_stage_can_be_shown():
    stages = compile_stages("var a\na = 1 + 2", THYMIO_II)
    assert stages.dump("tokens").splitlines()[-2:] == ["2:9 integer 2", "2:9 end-of-input"]
    assert "Binary operator=+  (2:7)" in stages.dump("tree")
    assert "Word address=128" in stages.dump("expanded")
    assert "Number value=3" in stages.dump("optimized")
    assert stages.dump("code").splitlines()[0] == "event init (65535), stack 1"
    assert assemble(stages, THYMIO_II).words == (3, 0xFFFF, 3, 0x1003, 0x4080, 0)


def test_an_unknown_stage_raises_value_error():
    with pytest.raises(ValueError, match="nonsense"):
        compile_stages("", THYMIO_II).dump("nonsense")


def test_the_first_error_is_the_only_one():
    with pytest.raises(CompileError) as caught:
        compile("a = 1\nb = 70000", THYMIO_II)
    assert caught.value.kind == "int16-range"
