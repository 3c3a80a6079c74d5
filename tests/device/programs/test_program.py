"""From a user's text to a program, or an error with its place in that text."""

from __future__ import annotations

import pytest

from aseba_vm.aesl import MAX_CHARACTERS
from thymio_sim_ros.device.programs.program import ProgramError, load_program

AESL = """\
<!DOCTYPE aesl-source>
<network>
<event size="1" name="ping"/>
<constant value="7" name="SEVEN"/>
<node nodeId="1" name="thymio-II">{code}</node>
</network>
"""


def test_bare_text_is_a_program():
    program = load_program("var a = 5", "a.txt")
    assert program.program.addresses["a"][1] == 1
    assert program.events == ()


def test_an_aesl_file_brings_events_and_constants():
    program = load_program(AESL.format(code="var a = SEVEN\nonevent ping\nemit ping a"), "a.aesl")
    assert program.events == (("ping", 1),)
    assert program.constants == (("SEVEN", 7),)


def test_a_byte_order_mark_does_no_harm():
    assert load_program("\ufeffvar a", "a.txt").program.addresses["a"]
    assert load_program("\ufeff" + AESL.format(code="var a"), "a.aesl").program.addresses["a"]


@pytest.mark.parametrize(
    ("text", "line", "column", "word"),
    [
        ("var a\na = bb", 2, 5, "bb"),
        (AESL.format(code="a = 1"), 5, 35, "a"),
        (AESL.format(code="var a\n  b = 1"), 6, 3, "b"),
        (AESL.format(code="var a = 1 &lt;&lt; 2\nvar c = d"), 6, 9, "d"),
        (AESL.format(code="var a\nif a &lt; 2 and b &gt; 3 then end"), 6, 17, "b"),
        (AESL.format(code="<![CDATA[var a\nif a < 2 and b > 3 then end]]>"), 6, 14, "b"),
        (AESL.format(code="<![CDATA[b = 1]]>"), 5, 44, "b"),
        (AESL.format(code="<toolsPlugins><a><b/></a></toolsPlugins>var a\n<!-- no -->b = 1"), 6, 12, "b"),
        (AESL.format(code="var a\n&#98; = 1"), 6, 1, "b"),
        (AESL.format(code="var a\n\tb = 1").replace("\n", "\r\n"), 6, 2, "b"),
        ("var a\r\nb = 1", 2, 1, "b"),
        ("\ufeffb = 1", 1, 1, "b"),
        ("<network><node name='thymio-II'>var a</nodes></network>", 1, 38, "expected </node>"),
    ],
)
def test_errors_have_their_place_in_the_file(text, line, column, word):
    with pytest.raises(ProgramError) as caught:
        load_program(text, "my.aesl")
    error = caught.value
    assert (error.line, error.column) == (line, column)
    assert word in error.message
    assert str(error).startswith(f"my.aesl: line {line}, column {column}: ")


def test_the_only_program_of_a_file_is_taken_whatever_its_node_is_called():
    assert load_program('<network><node name="my Thymio">var a</node></network>', "a.aesl").program.addresses["a"]


VPL = """<network>{event}<node name="{name}">emit pair_run 0
_emit debug_log [1, 2]
<toolsPlugins><ThymioVisualProgramming><vplroot xml-format-version="1"/></ThymioVisualProgramming></toolsPlugins></node>
</network>"""


@pytest.mark.parametrize("name", ["thymio-II", "", "Thymio_4 on LAPTOP-8J2 - 8636"])
def test_the_events_of_vpl_need_no_declaration(name):
    assert load_program(VPL.format(event="", name=name), "vpl.aesl").events == (("pair_run", 1), ("debug_log", 14))


def test_an_event_of_vpl_that_is_declared_stays_as_it_is():
    text = VPL.format(event='<event size="1" name="pair_run"/>', name="thymio-II")
    assert load_program(text, "vpl.aesl").events == (("pair_run", 1), ("debug_log", 14))
    assert load_program(text.replace("pair_run", "ping"), "vpl.aesl").events[0] == ("ping", 1)


def test_other_programs_declare_the_events_of_vpl_themselves():
    with pytest.raises(ProgramError, match="no event is called 'pair_run'"):
        load_program(VPL.format(event="", name="").replace("ThymioVisual", "Other").replace("vplroot", "x"), "a.aesl")


@pytest.mark.parametrize(
    ("definitions", "column", "word"),
    [
        ('<event size="1" name="a"/><event size="2" name="a"/>', 58, "event 'a' again"),
        ('<constant value="1" name="A"/><constant value="1" name="A"/>', 66, "constant 'A' again"),
        ('<event size="300" name="a"/>', 23, "expected 0 to 258 words"),
        ('<event size="1" name=""/>', 32, "the name ''"),
        ('<constant value="40000" name="A"/>', 27, "expected -32768 to 32767"),
    ],
)
def test_bad_definitions_are_refused_in_place(definitions, column, word):
    with pytest.raises(ProgramError) as caught:
        load_program(f'<network>{definitions}<node name="thymio-II">var a</node></network>', "a.aesl")
    assert (caught.value.line, caught.value.column) == (1, column)
    assert word in caught.value.message


def test_each_program_of_a_file_must_compile():
    with pytest.raises(ProgramError) as caught:
        load_program(AESL.format(code='</node>\n<node nodeId="2" name="thymio-II">a = 1'), "a.aesl")
    assert (caught.value.line, caught.value.column) == (6, 35)


def test_a_fault_has_its_line_in_the_file():
    program = load_program(AESL.format(code="\nvar a<toolsPlugins>\n</toolsPlugins>\na = 1 / a"), "a.aesl")
    assert program.line_of(len(program.program.words) - 2) == 8


def test_the_error_of_an_unfinished_program_is_at_its_end():
    with pytest.raises(ProgramError) as caught:
        load_program(AESL.format(code="var a\na = "), "a.aesl")
    assert (caught.value.line, caught.value.column) == (6, 4)


def test_a_program_too_large_for_the_robot_is_refused():
    with pytest.raises(ProgramError, match="memory"):
        load_program("var a[600]", "a.txt")


def test_a_huge_text_is_refused_at_once():
    with pytest.raises(ProgramError, match="at most"):
        load_program("#" * (MAX_CHARACTERS + 1), "a.txt")
