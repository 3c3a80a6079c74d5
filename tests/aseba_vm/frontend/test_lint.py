import pytest

from aseba_vm import TargetDescription, Variable, compile
from aseba_vm.targets import THYMIO_II


def doubts(source):
    return [warning.located("f") for warning in compile(source, THYMIO_II).warnings]


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("var a\na = 1", []),
        (
            "callsub s\nsub s\nif acc[0] == 1 then return end",
            [
                "f:2:1: warning: subroutine 's' may run on into the code after it,"
                " as its last statement does not always return"
            ],
        ),
        ("sub s", ["f:1:1: warning: subroutine 's' is never called"]),
        ("onevent tap\nreturn\nacc[0] = 1", ["f:3:8: warning: this is never executed: it comes after a return"]),
        ("onevent tap\nreturn\nonevent prox", []),
        (
            "onevent tap\nwhen 1 == 1 do acc[0] = 1 end",
            ["f:2:1: warning: the condition of this 'when' never changes, so there is no moment when it becomes true"],
        ),
        ("onevent tap\nwhen acc[0] == 1 do acc[0] = 2 end", []),
        (
            "var i\nfor i in 0:32766 step 3 do acc[0] = i end",
            ["f:2:1: warning: this loop may never end: the value after 32766 does not fit in 16 bits and wraps round"],
        ),
        (
            "var i\nfor i in 5:-32767 step -3 do acc[0] = i end",
            ["f:2:1: warning: this loop may never end: the value after -32767 does not fit in 16 bits and wraps round"],
        ),
        ("var i\nfor i in 0:32765 step 2 do acc[0] = i end", []),
        ("var i\nfor i in 0:32766 do acc[0] = i end\nfor i in 32766:32766 step 9 do acc[0] = i end", []),
        (
            "var t[9]\nt[0] = t[acc + t[acc[1] + t[0]]]",
            ["f:2:10: warning: only the first element of 'acc' is used as index"],
        ),
    ],
)
def test_warnings_have_their_position(source, expected):
    assert doubts(source) == expected


def test_a_block_too_long_for_a_jump_has_a_warning():
    target = TargetDescription("large", 100, 60000, 100, (Variable("a", 1),))
    program = compile("while a == 1 do\n" + "a = 1\n" * 1100 + "end", target)
    assert [warning.kind for warning in program.warnings] == ["warning-far-jump"]


def test_doubts_do_not_change_the_bytecode():
    assert compile("sub s", THYMIO_II).words == (1, 0xE000)
