import pytest

from aseba_vm import CompileError
from aseba_vm.frontend.lexer import tokenize


@pytest.mark.parametrize("text", ["a", "_", "a.b", "9", "é", "ⓐ", "٣", "\u0345", "a\u0345"])
def test_letters_digits_and_some_marks_make_words(text):
    assert [token.kind in ("identifier", "integer") for token in tokenize(text)] == [True, False]


@pytest.mark.parametrize("text", [".a", "²", "½", "\u0300", "a\u0300", "\U0001f600"])
def test_other_characters_do_not(text):
    with pytest.raises(CompileError, match="cannot start a word"):
        tokenize(text)
