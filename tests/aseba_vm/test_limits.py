"""Texts that try to exhaust memory or stack end in one error with a position, whatever the recursion limit."""

import dataclasses

import pytest

from aseba_vm import AeslError, CompileError, aesl, compile
from aseba_vm.targets import THYMIO_II

DEEP = 100_000

#: Room for large programs, so that the passes behind the parser are reached too.
LARGE = dataclasses.replace(THYMIO_II, variables_size=4096, bytecode_size=60000, stack_size=30000)

HOSTILE = {
    "open parentheses": "var a a = " + "(" * DEEP,
    "parentheses": "var a a = " + "(" * DEEP + "1" + ")" * DEEP,
    "lists": "var a a = " + "[" * DEEP,
    "indexes": "var a[4] a[0] = " + "a[" * DEEP,
    "signs": "var a a = " + "~" * DEEP + "a",
    "negations": "var a if " + "not " * DEEP + "a == 1 then end",
    "blocks": "var a " + "if a == 1 then " * DEEP,
    "elseif": "var a if a == 1 then " + "elseif a == 1 then " * DEEP,
    "sums": "var a a = a" + "+a" * DEEP,
    "zero bytes": "\0" * 1_000_000,
    "one long name": "x" * 1_000_000,
    "digits": "var a = " + "9" * 1_000_000,
    "an open comment": "#*" + "\n" * 1_000_000,
    "variables": "".join(f"var v{number} " for number in range(10_000)),
    "a large array": "var a[32767]",
    "a large sum of arrays": "var a[300] a = a" + "+a" * 10_000,
    "a chain of subroutines": "".join(f"sub s{number} callsub s{number + 1} " for number in range(20_000)),
}


@pytest.mark.parametrize("target", [THYMIO_II, LARGE], ids=["robot", "large"])
@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_program_is_refused_in_place(name, target):
    with pytest.raises(CompileError) as caught:
        compile(HOSTILE[name], target)
    assert caught.value.pos is not None
    assert len(str(caught.value)) < 300


DEEP_ENOUGH = {
    "parentheses": "var a a = " + "(" * 15_000 + "1" + ")" * 15_000,
    "constant sums": "var a a = 1" + "+ 1" * 15_000,
    "constant indexes": "var a[4] a[0] = " + "a[0 * a[" * 3_000 + "1" + "]]" * 3_000,
    "dynamic indexes": "var a[4] a[0] = " + "a[" * 9_000 + "a[0]*2" + "]" * 9_000,
    "blocks": "var a " + "if a == 1 then " * 4_500 + "a = 2 " + "end " * 4_500,
    "elseif": "var a if a == 1 then a = 2 " + "elseif a == 3 then a = 4 " * 3_500 + "end",
    "loops": "var a " + "while a == 1 do " * 4_500 + "a = 2 " + "end " * 4_500,
    "line ends": "\n" * 1_000_000,
    "comments": "#\n" * 200_000,
}


@pytest.mark.parametrize("name", DEEP_ENOUGH)
def test_depth_alone_is_no_error(name):
    assert compile(DEEP_ENOUGH[name], LARGE).words


@pytest.mark.parametrize(
    "text",
    [
        "",
        "\0" * 1_000_000,
        "<a>" * 300_000,
        '<!DOCTYPE a [<!ENTITY b "c">]><network/>',
        "<network><event/></network>",
        '<network><event name="a" size="x"/></network>',
        '<network><event name="a" size="-1"/></network>',
        f'<network><constant name="a" value="{"9" * 6000}"/></network>',
        '<network><node name="a"></network>',
        "\ud800",
    ],
)
def test_a_hostile_file_is_refused_in_place(text):
    with pytest.raises(AeslError) as caught:
        aesl.loads(text)
    assert caught.value.line >= 1
    assert caught.value.column >= 1
