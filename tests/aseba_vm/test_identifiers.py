import pytest

from aseba_vm.identifiers import is_word


@pytest.mark.parametrize("text", ["a", "_", "a.b", "9", "é", "ⓐ", "٣", "\u0345", "a\u0345"])
def test_letters_digits_and_some_marks_make_words(text):
    assert is_word(text)


@pytest.mark.parametrize("text", ["", ".a", "²", "½", "a-b", "a b", "\u0300", "\U0001f600"])
def test_other_characters_do_not(text):
    assert not is_word(text)
