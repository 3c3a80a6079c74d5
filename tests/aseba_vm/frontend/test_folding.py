"""Folding and simplification (docs/spec/aseba-language.md section 9), tested by the remaining code."""

import pytest

from aseba_vm import CompileError, compile_stages
from aseba_vm.targets import THYMIO_II


def code(source):
    """Return the instructions of the initialization without the final stop."""
    stages = compile_stages(f"var a var b {source}", THYMIO_II, events=[("e", 1)])
    return [str(instruction) for segment in stages.segments for instruction in segment.code][:-1]


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("1 + 2 * 3", 7),
        ("-7 / 2", -3),
        ("-7 % 2", -1),
        ("7 % 0 + 0", None),
        ("(32767 + 1) / 2", 16384),
        ("1 << 33", 2),
        ("-1 >> 31", -1),
        ("abs -5", 5),
        ("~5", -6),
        ("b * 0", 0),
        ("b & 0", 0),
        ("b | -1", -1),
        ("(5 - 5) * (b / b)", 0),
    ],
)
def test_constants_are_folded_in_32_bits(expression, value):
    if value is None:
        with pytest.raises(CompileError, match="division by zero"):
            code(f"a = {expression}")
    else:
        assert code(f"a = {expression}") == [f"push {value}" if abs(value) < 2048 else f"pushl {value}", "store 128"]


@pytest.mark.parametrize("expression", ["b * 1", "1 * b", "b / 1", "b + 0", "0 + b", "b - 0", "b | 0", "-1 & b"])
def test_neutral_operands_vanish(expression):
    assert code(f"a = {expression}") == ["load 129", "store 128"]


@pytest.mark.parametrize("expression", ["0 - b", "b ^ 0", "b << 0", "b - b"])
def test_nothing_else_is_simplified(expression):
    assert len(code(f"a = {expression}")) == 4


def test_a_power_of_two_on_the_right_becomes_a_shift():
    assert code("a = b * 8") == ["load 129", "push 3", "binary <<", "store 128"]
    assert code("a = b / 4") == ["load 129", "push 2", "binary >>", "store 128"]
    assert code("a = 8 * b")[2] == "binary *"
    assert code("a = b % 8")[2] == "binary %"


def test_not_is_pushed_into_conditions():
    assert code("if not (a == 1 or b < 2) then a = 1 end")[:7] == [
        "load 128",
        "push 1",
        "binary !=",
        "load 129",
        "push 2",
        "binary >=",
        "branch if and else +4",
    ]


def test_a_constant_condition_keeps_the_chosen_block():
    assert code("if 1 == 1 then a = 1 else a = 2 end") == ["push 1", "store 128"]
    assert code("when 1 == 1 do a = 1 end") == ["push 1", "store 128"]


def test_empty_statements_disappear():
    assert code("if a == 1 then else end while a == 1 do end while 1 == 2 do a = 1 end a = 3")[0] == "push 3"


def test_an_empty_else_is_kept():
    assert "jump +1" in code("if a == 1 then b = 1 else if 1 == 2 then b = 2 end end")


@pytest.mark.parametrize(
    ("source", "kind"),
    [
        ("a = b / 0", "division-by-zero"),
        ("a = abs (-32767 - 1)", "abs-of-minimum"),
        ("while 1 == 1 do end", "infinite-loop"),
        ("emit e (not (a + 1))", "negated-number"),
        ("a = (-32768 * 32767 * 2 - 32767 - 32767 - 2) / -1", "constant-overflow"),
    ],
)
def test_what_folding_finds_is_refused(source, kind):
    with pytest.raises(CompileError) as caught:
        code(source)
    assert caught.value.kind == kind


def test_a_remainder_by_zero_is_left_to_the_machine():
    assert code("a = b % 0")[2] == "binary %"
