"""Values of variables as FlexBuffers."""

from __future__ import annotations

import contextlib
import random

import pytest
from flatbuffers import flexbuffers
from hypothesis import given
from hypothesis import strategies as st

from thymio_sim_ros.network.tdm.protocol.errors import ValueTypeError
from thymio_sim_ros.network.tdm.protocol.values import NO_VALUE, decode_value, encode_value

INT16 = st.integers(-0x8000, 0x7FFF)
VALUES = st.lists(INT16, max_size=10) | st.lists(st.integers(-0x80, 0x7F), min_size=80, max_size=300)


@given(VALUES | st.lists(INT16, min_size=80, max_size=90))
def test_a_value_is_written_as_the_library_does_it(words: list[int]) -> None:
    assert encode_value(tuple(words)) == bytes(flexbuffers.Dumps(words))


@given(VALUES)
def test_a_value_survives_the_way_to_bytes_and_back(words: list[int]) -> None:
    assert decode_value(encode_value(tuple(words))) == tuple(words)


def test_null_is_written_as_the_library_does_it() -> None:
    assert bytes(flexbuffers.Dumps(None)) == NO_VALUE
    assert decode_value(NO_VALUE) == ()


def test_the_vector_of_tdmclient_is_read() -> None:
    # docs/spec/aseba-protocol.md section 2.2
    assert decode_value(bytes.fromhex("0300 0100 FEFF 2C01 05 05 05 09 29 01")) == (1, -2, 300)


def _typed(element: flexbuffers.Type, numbers: list[int]) -> bytes:
    builder = flexbuffers.Builder()
    if len(numbers) in (2, 3, 4):
        with builder.TypedVector():
            for number in numbers:
                builder.UInt(number) if element is flexbuffers.Type.UINT else builder.Int(number)
        return bytes(builder.Finish())
    builder.TypedVectorFromElements(numbers, element)
    return bytes(builder.Finish())


@pytest.mark.parametrize("element", [flexbuffers.Type.INT, flexbuffers.Type.UINT])
@pytest.mark.parametrize("numbers", [[5], [1, 2], [1, 2, 300], [7] * 9])
def test_typed_vectors_are_read(element: flexbuffers.Type, numbers: list[int]) -> None:
    assert decode_value(_typed(element, numbers)) == tuple(numbers)


def test_single_numbers_are_read() -> None:
    assert decode_value(bytes(flexbuffers.Dumps(-5))) == (-5,)
    assert decode_value(bytes(flexbuffers.Dumps(300))) == (300,)


def test_unsigned_numbers_of_16_bits_become_signed() -> None:
    assert decode_value(bytes(flexbuffers.Dumps([0xFFFF, 0x8000, 0x7FFF]))) == (-1, -0x8000, 0x7FFF)


@pytest.mark.parametrize(
    "value", [1.5, "text", {"a": 1}, [[1]], [1, "b"], True, [0x10000], -0x8001, b"blob", [1.0], [None], [0] * 5000]
)
def test_other_values_are_rejected(value: object) -> None:
    with pytest.raises(ValueTypeError, match="expected a FlexBuffer of integers"):
        decode_value(bytes(flexbuffers.Dumps(value)))


@given(st.binary(max_size=40))
def test_any_bytes_are_a_value_or_one_error(data: bytes) -> None:
    _decode(data)


def test_changed_values_are_values_or_one_error() -> None:
    chance = random.Random(6)
    samples = [flexbuffers.Dumps(value) for value in (1, [1, 2, 3], [300] * 90, {"a": [1]}, ["text"], 1.5, None)]
    for _ in range(4000):
        changed = bytearray(chance.choice(samples))
        for _ in range(chance.randint(1, 4)):
            changed[chance.randrange(len(changed))] = chance.randrange(256)
        _decode(bytes(changed))


def _decode(data: bytes) -> None:
    with contextlib.suppress(ValueTypeError):
        assert len(decode_value(data)) <= 4096
