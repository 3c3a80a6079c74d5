import pytest

from aseba_vm import CompileError
from aseba_vm.frontend.lexer import MAX_TOKENS, tokenize


def kinds(text):
    return [token.kind for token in tokenize(text)]


def place(text, index=0):
    pos = tokenize(text)[index].pos
    return (pos.offset, pos.row, pos.col)


def test_keywords_symbols_names_and_numbers_are_distinguished():
    assert kinds("if.x if <<= a. 0x") == ["identifier", "if", "<<=", "identifier", "integer", "end-of-input"]


def test_the_longest_symbol_wins():
    assert kinds("a+++b") == ["identifier", "++", "+", "identifier", "end-of-input"]


@pytest.mark.parametrize(
    ("text", "value"), [("007", 7), ("0x", 0), ("0xFFFF", -1), ("0x7fff", 32767), ("0b101", 5), ("65535", 65535)]
)
def test_the_value_of_a_number(text, value):
    assert tokenize(text)[0].value == value


@pytest.mark.parametrize(
    ("text", "kind", "arguments"),
    [
        ("12a", "bad-number", ()),
        ("1.5", "bad-number", ()),
        ("0xG", "bad-hex-number", ()),
        ("0b2", "bad-binary-number", ()),
        ("0X1", "bad-number-base", ()),
        ("0_1", "bad-number-base", ()),
        ("65536", "int16-range", (65536,)),
        ("9" * 5000, "int16-range", (2**63 - 1,)),
        ("!", "lone-exclamation", ()),
        ("a\x00", "illegal-character", ("0",)),
        ("½", "illegal-character", ("bd",)),
        ("#*#", "unterminated-comment", ()),
    ],
)
def test_what_is_no_token_is_refused(text, kind, arguments):
    with pytest.raises(CompileError) as caught:
        tokenize(text)
    assert (caught.value.kind, caught.value.arguments) == (kind, arguments)


def test_letters_of_every_script_make_names():
    assert kinds("été ⓐb ٣") == ["identifier"] * 3 + ["end-of-input"]


def test_shifts_carry_the_place_of_their_second_character():
    assert place("a << 1", 1) == (3, 0, 3)
    assert place("a <= 1", 1) == (2, 0, 2)


def test_the_column_after_a_line_comment_is_one_too_large():
    assert place("# c\nab") == (4, 1, 1)
    assert place("# c\r\nab") == (5, 1, 0)


def test_a_tab_counts_four_in_comments_only():
    assert place("\ta") == (1, 0, 1)
    assert place("#*\t*#a") == (5, 0, 8)
    assert place("#*\n\t*#a") == (6, 1, 6)
    assert place("#*\t*#\t\ta") == (7, 0, 10)


def test_the_end_has_the_place_of_the_last_character():
    assert place("") == (-1, 0, -1)
    assert place("a\n", 1) == (1, 1, -1)
    assert place("a # c", 1) == (5, 0, 5)
    assert place("a #", 1) == (2, 0, 2)


def test_a_lone_carriage_return_resets_the_column_only():
    assert place("a\rb", 1) == (2, 0, 0)


def test_a_program_of_too_many_words_is_refused_in_place():
    with pytest.raises(CompileError) as caught:
        tokenize("a " * (MAX_TOKENS + 5))
    assert caught.value.kind == "too-many-tokens"
    assert caught.value.pos.offset == 2 * MAX_TOKENS
