"""The variable memory keeps its size and its value range in any storage."""

from __future__ import annotations

import ctypes

import pytest

from aseba_vm.machine.data_memory import Variables


@pytest.fixture(params=["at home", "elsewhere"])
def variables(request):
    memory = Variables(6)
    memory[1:4] = [5, -6, 7]
    if request.param == "elsewhere":
        memory.move_to((ctypes.c_int16 * 6)())
    return memory


def test_words_are_read_and_stored(variables):
    variables[0] = -32768
    assert variables[0] == -32768
    assert variables[1:4] == [5, -6, 7]
    assert list(variables) == [-32768, 5, -6, 7, 0, 0]
    assert variables == [-32768, 5, -6, 7, 0, 0]
    assert variables != [0] * 6
    assert len(variables) == 6
    assert repr(variables) == "Variables([-32768, 5, -6, 7, 0, 0])"


@pytest.mark.parametrize("value", [32768, -32769])
def test_a_word_beyond_sixteen_bits_is_refused(variables, value):
    with pytest.raises(ValueError, match=f"{value} found, expected -32768 to 32767"):
        variables[0] = value
    with pytest.raises(ValueError, match=f"{value} found"):
        variables[:2] = [0, value]
    assert variables == [0, 5, -6, 7, 0, 0]


def test_the_number_of_words_cannot_change(variables):
    with pytest.raises(ValueError, match="3 words found, expected 2"):
        variables[0:2] = [1, 2, 3]
    with pytest.raises(IndexError):
        variables[6] = 0
    assert variables == [0, 5, -6, 7, 0, 0]


def test_words_move_back_from_an_engine():
    memory = Variables(3)
    memory[:] = [1, 2, 3]
    place = (ctypes.c_int16 * 3)()
    memory.move_to(place, owner=place)
    memory[1] = 9
    assert list(place) == [1, 9, 3]
    memory.move_back()
    place[0] = 7
    assert memory == [1, 9, 3]
