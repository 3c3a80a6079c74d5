import pytest

from aseba_vm import compile
from aseba_vm.bytecode import describe, disassemble, instructions, signed, signed12
from aseba_vm.targets import THYMIO_II


@pytest.mark.parametrize(
    ("words", "text"),
    [
        ((0x0000,), "stop"),
        ((0x1FFF,), "push -1"),
        ((0x2000, 0xFFFF), "pushl -1"),
        ((0x3080,), "load 128"),
        ((0x5080, 4), "loadx 128 size 4"),
        ((0x7001,), "unary abs"),
        ((0x7003,), "unary not"),
        ((0x8011,), "binary and"),
        ((0x80FF,), "binary 255"),
        ((0x9FF8,), "jump -8"),
        ((0xA30C, 4), "branch when > else +4 (was true)"),
        ((0xB000, 128, 2), "emit 0 from 128 size 2"),
        ((0xC005,), "native 5"),
        ((0xF123,), "unknown 0xf123"),
    ],
)
def test_an_instruction_as_text(words, text):
    assert describe(words) == text


def test_words_are_read_with_their_sign():
    assert [signed(word) for word in (0, 0x7FFF, 0x8000, 0xFFFF)] == [0, 32767, -32768, -1]
    assert [signed12(word) for word in (0x1000, 0x17FF, 0x1800, 0x1FFF)] == [0, 2047, -2048, -1]


def test_instructions_follow_each_other():
    assert list(instructions([0x2000, 7, 0xB000, 1, 2, 0])) == [(0, (0x2000, 7)), (2, (0xB000, 1, 2)), (5, (0,))]


def test_the_listing_of_a_program_shows_addresses_and_targets():
    words = compile("var a while a < 5 do a++ end", THYMIO_II).words
    assert disassemble(words).splitlines() == [
        "    0  0003            code at 3",
        "    1  FFFF 0003       event 65535 at 3",
        "    3  3080            load 128",
        "    4  1005            push 5",
        "    5  A00E 0007       branch if < else +7 -> 12",
        "    7  3080            load 128",
        "    8  1001            push 1",
        "    9  8002            binary +",
        "   10  4080            store 128",
        "   11  9FF8            jump -8 -> 3",
        "   12  0000            stop",
    ]


def test_an_empty_image_has_an_empty_listing():
    assert disassemble([]) == ""
