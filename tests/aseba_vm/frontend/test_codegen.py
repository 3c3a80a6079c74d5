import pytest

from aseba_vm import CompileError, compile, compile_stages
from aseba_vm.targets import THYMIO_II


def segments(source):
    return compile_stages(source, THYMIO_II, events=[("e", 1)]).segments


def test_the_short_constant_is_chosen_by_the_whole_value():
    assert [str(code) for code in segments("var a a = 2047 a = -2048 a = 2 * 32767 + 7")[0].code][::2][:3] == [
        "push 2047",
        "pushl -2048",
        "pushl 5",
    ]


def test_handlers_without_code_do_not_exist():
    assert [segment.name for segment in segments("onevent prox onevent tap if 1 == 2 then return end")] == []


def test_an_empty_subroutine_still_returns():
    assert [str(code) for code in segments("sub s")[0].code] == ["ret"]


def test_every_event_stops_once_more():
    assert [str(code) for code in segments("onevent tap return")[0].code] == ["stop", "stop"]


@pytest.mark.parametrize(
    ("body", "falls"),
    [
        ("return", False),
        ("if a == 1 then return end", True),
        ("if a == 1 then a = 2 else return end", True),
        ("if a == 1 then return end return", False),
        ("while a == 1 do return end", False),
        ("when a == 1 do return end", True),
    ],
)
def test_a_subroutine_may_run_on_past_its_last_return(body, falls):
    assert segments(f"var a sub s {body}")[0].falls_through is falls


def test_the_row_of_the_last_word_is_that_of_end():
    segment = segments("onevent tap\nif acc[0] == 1 then\nacc[1] = 2\nend")[0]
    assert segment.code[-1].row == 3


def test_the_row_after_a_chain_is_unknown():
    segment = segments("onevent tap\nif acc[0] == 1 then\nelseif acc[0] == 2 then\nacc[1] = 2\nend")[0]
    assert segment.code[-1].row is None


@pytest.mark.parametrize(
    "source",
    [
        "callsub s sub s callsub s",
        "sub s callsub t sub t callsub s",
        "var a a = " + "a + " * 40 + "a",
        "".join(f"sub s{number} callsub s{number + 1} " for number in range(40)) + "sub s40 onevent tap callsub s0",
    ],
)
def test_programs_that_could_need_too_much_stack_are_refused(source):
    with pytest.raises(CompileError) as caught:
        compile(source, THYMIO_II)
    assert caught.value.kind == "stack-overflow"


def test_a_program_larger_than_the_memory_is_refused():
    with pytest.raises(CompileError) as caught:
        compile("acc[0] = 3 " * 800, THYMIO_II)
    assert caught.value.kind == "bytecode-too-large"
