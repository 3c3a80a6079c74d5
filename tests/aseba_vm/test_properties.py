"""Properties of every program."""

from __future__ import annotations

import hypothesis
import pytest
from hypothesis import strategies as st

from aseba_vm import CompileError, compile
from aseba_vm.bytecode import Instruction, Op, describe, instructions
from aseba_vm.frontend.formatter import format_program
from aseba_vm.frontend.lexer import KEYWORDS, SYMBOLS
from aseba_vm.targets import THYMIO_II
from tests.aseba_vm.programs import Writer
from tests.aseba_vm.vectors import compiled

EVENTS = [("ping", 1), ("pair", 2), ("nothing", 0)]
PLACELESS = {"stack-overflow", "bytecode-too-large"}

words = st.lists(st.integers(0, 0xFFFF), max_size=60)
pieces = st.sampled_from(
    (*sorted(KEYWORDS), *SYMBOLS, "a", "acc", "7", "0x1F", "ping", "\n", "\t", "# c\n", "#*", "*#", "é")
)
sources = st.one_of(st.text(max_size=40), st.lists(pieces, max_size=30).map(" ".join))


@hypothesis.given(words)
def test_what_is_decoded_encodes_to_the_same_words(image):
    decoded = [code for _, code in instructions(image)]
    assert [word for code in decoded for word in code] == image
    for code in decoded:
        assert Instruction(Op(code[0] >> 12), code[0] & 0xFFF, code[1:]).words == code
        assert describe(code)


@hypothesis.given(sources)
@hypothesis.settings(max_examples=400)
def test_any_text_compiles_or_is_refused_at_a_place_inside_it(source):
    text = "var a\n" + source
    refusal = None
    try:
        compile(text, THYMIO_II, EVENTS)
    except CompileError as error:
        refusal = error
    if refusal is not None and refusal.kind not in PLACELESS:
        assert refusal.pos is not None
        assert 0 <= refusal.pos.offset <= len(text)
        assert 0 <= refusal.pos.row <= text.count("\n")


def check_lines(program):
    """Check that the mappings between rows and addresses agree."""
    start = 2 * len(program.events) + 1
    places = [pc for pc, _ in instructions(program.words, start)]
    rows = {program.row_of(pc) for pc in places}
    for row in rows - {None}:
        addresses = program.addresses_of(row)
        assert addresses
        assert {program.row_of(pc) for pc in addresses} == {row}
    assert sorted(pc for row in rows - {None} for pc in program.addresses_of(row)) == [
        pc for pc in places if program.row_of(pc) is not None
    ]
    assert program.row_of(start - 1) is None
    assert program.row_of(len(program.words)) is None
    for entry in (*program.events, *program.subs):
        if entry.address < len(program.words):
            assert program.segment_of(entry.address) is not None


@pytest.mark.parametrize("seed", range(60))
def test_random_programs_keep_their_meaning_in_regular_layout(seed):
    source = Writer(90_000 + seed).program()
    try:
        program = compile(source, THYMIO_II, EVENTS, [("N", 4)])
    except CompileError:
        return
    once = format_program(source)
    assert compile(once, THYMIO_II, EVENTS, [("N", 4)]).words == program.words
    assert format_program(once) == once
    check_lines(program)


@pytest.mark.vectors("aseba-compile")
def test_programs_of_the_reference_keep_their_meaning_in_regular_layout(vector):
    program = compiled(vector)
    once = format_program(vector["source"])
    assert compiled(vector | {"source": once}).words == program.words
    assert format_program(once) == once
    check_lines(program)
