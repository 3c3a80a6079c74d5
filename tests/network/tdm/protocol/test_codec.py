"""Messages of the Thymio Device Manager to bytes and back, and bytes that are no message."""

from __future__ import annotations

import contextlib
import os
import random
import struct
from typing import Any
from uuid import UUID

import pytest
from flatbuffers import Builder
from hypothesis import given
from hypothesis import strategies as st

from thymio_sim_ros.network.tdm.protocol import messages
from thymio_sim_ros.network.tdm.protocol.codec import MAX_MESSAGE_BYTES, StreamReader, decode, encode, framed
from thymio_sim_ros.network.tdm.protocol.errors import TdmFrameError
from thymio_sim_ros.network.tdm.protocol.messages import (
    MESSAGES,
    ConnectionHandshake,
    Message,
    NamedValue,
    SetVariables,
)
from thymio_sim_ros.network.tdm.protocol.wire_types import Identifier, Octets, Scalar, Tables, Text, slots_of
from thymio_sim_ros.network.tdm.protocol.writer import write_table

NODE = UUID(int=0x0123456789ABCDEF0123456789ABCDEF)
MUTATIONS = int(os.environ.get("THYMIO_SIM_FUZZ", "4000"))
"""Changed buffers of the fuzz test; 100000 take about a minute."""

_RANGES = {"<B": (0, 255), "<H": (0, 0xFFFF), "<I": (0, 2**32 - 1), "<Q": (0, 2**64 - 1)} | {
    "<h": (-0x8000, 0x7FFF),
    "<i": (-(2**31), 2**31 - 1),
}


def _contents(kind: type) -> st.SearchStrategy[Any]:
    return st.builds(kind, **{slot.name: _content(slot.wire) for slot in slots_of(kind)})


def _content(wire: object) -> st.SearchStrategy[Any]:
    match wire:
        case Scalar():
            if wire.layout.format == "<d":
                return st.floats(allow_nan=False)
            return st.booleans() if wire.layout.format == "<?" else st.integers(*_RANGES[wire.layout.format])
        case Text():
            return st.text(st.characters(codec="utf-8"), max_size=20)
        case Octets():
            return st.binary(max_size=20)
        case Identifier():
            return st.none() | st.uuids()
        case Tables():
            return st.lists(_contents(wire.kind), max_size=3).map(tuple)
    raise AssertionError(wire)


@given(st.one_of([_contents(kind) for kind in MESSAGES]))
def test_every_message_survives_the_way_to_bytes_and_back(message: Message) -> None:
    assert decode(encode(message)) == message


def test_the_handshake_of_tdmclient_has_only_defaults() -> None:
    # docs/spec/aseba-protocol.md section 2.3: the vtables are after the data, no field is present.
    recorded = bytes.fromhex("04000000ECFFFFFF0100000004000000FCFFFFFF0400040008000C0004000800")
    assert decode(recorded) == ConnectionHandshake(1, 1, 102400)


def test_a_message_without_its_table_has_the_defaults() -> None:
    # The root has its first slot only: type 29.
    root = struct.pack("<IHHHHiBxxx", 12, 6, 5, 4, 0, 8, 29)
    assert decode(root) == messages.Ping()


@pytest.mark.parametrize("number", [0, 36, 255])
def test_an_unknown_type_is_rejected(number: int) -> None:
    root = struct.pack("<IHHHHiBxxx", 12, 6, 5, 4, 0, 8, number)
    with pytest.raises(TdmFrameError, match=f"message_type: expected 1 to 35, found {number}"):
        decode(root)


def _samples() -> list[bytes]:
    value = NamedValue("motor.left.target", b"\1\0\5\1\1\1")
    node = messages.Node(NODE, NODE, 2, 2, "thymio_0", 3, "14", "14")
    function = messages.AsebaNativeFunction(0, "math.fill", "", (messages.AsebaNativeParameter("x", 2**32 - 1),))
    filled = [
        ConnectionHandshake(token=b"abcd", uuid=NODE, password="secret"),
        SetVariables(1, NODE, (value, value)),
        messages.NodesChanged((node, node)),
        messages.NodeAsebaVMDescription(7, NODE, functions=(function,) * 3),
        messages.CompileAndLoadCodeOnVM(3, NODE, 1, "var a[3] = [1, 2, 3]\nonevent button.left\n", 2),
    ]
    return [encode(message) for message in (*filled, *(kind() for kind in MESSAGES))]


def test_a_cut_buffer_is_a_message_or_one_error() -> None:
    for sample in _samples():
        for length in range(len(sample)):
            _decode(sample[:length])


@given(st.binary(max_size=400))
def test_any_bytes_are_a_message_or_one_error(data: bytes) -> None:
    _decode(data)


def test_changed_bytes_are_a_message_or_one_error() -> None:
    chance = random.Random(5)
    samples = _samples()
    for _ in range(MUTATIONS):
        changed = bytearray(chance.choice(samples))
        for _ in range(chance.randint(1, 8)):
            at = chance.randrange(len(changed))
            if chance.random() < 0.3:
                struct.pack_into("<I", changed, min(at, len(changed) - 4), chance.choice((0, 1, 4, 2**31, 2**32 - 1)))
            else:
                changed[at] = chance.randrange(256)
        _decode(bytes(changed))


def _decode(data: bytes) -> None:
    """Decode; any exception but the one that is documented fails the test."""
    with contextlib.suppress(TdmFrameError):
        assert type(decode(data)) in MESSAGES


def test_a_small_buffer_cannot_unpack_to_a_large_message() -> None:
    """20000 elements that are all one variable with a value of 10000 bytes: 200 MB in a buffer of 90 kB."""
    builder = Builder()
    variable = write_table(builder, NamedValue("a", bytes(10_000)))
    builder.StartVector(4, 20_000, 4)
    for _ in range(20_000):
        builder.PrependUOffsetTRelative(variable)
    variables = builder.EndVector()
    builder.StartObject(3)
    builder.PrependUOffsetTRelativeSlot(2, variables, 0)
    content = builder.EndObject()
    builder.StartObject(2)
    builder.PrependUOffsetTRelativeSlot(1, content, 0)
    builder.PrependUint8Slot(0, 17, 0)
    builder.Finish(builder.EndObject())
    data = bytes(builder.Output())
    assert len(data) < MAX_MESSAGE_BYTES
    with pytest.raises(TdmFrameError, match=r"SetVariables\.vars.*expected at most .* bytes to read"):
        decode(data)


def test_a_buffer_above_the_limit_is_rejected_unread() -> None:
    with pytest.raises(TdmFrameError, match="expected at most 102400 bytes, found 102401"):
        decode(bytes(MAX_MESSAGE_BYTES + 1))


@given(st.lists(st.binary(max_size=30), max_size=6), st.data())
def test_a_stream_may_be_cut_anywhere(buffers: list[bytes], data: st.DataObject) -> None:
    stream = b"".join(framed(buffer) for buffer in buffers)
    cuts = sorted(data.draw(st.lists(st.integers(0, len(stream)), max_size=10)))
    reader = StreamReader()
    found = [
        buffer
        for start, end in zip([0, *cuts], [*cuts, len(stream)], strict=True)
        for buffer in reader.feed(stream[start:end])
    ]
    assert found == buffers


def test_a_stream_with_an_impossible_length_is_rejected() -> None:
    with pytest.raises(TdmFrameError, match="length: expected at most 102400 bytes, found 4294967295"):
        StreamReader().feed(b"\xff\xff\xff\xff")
