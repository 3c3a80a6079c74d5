"""Messages of the Aseba network: bytes of recorded exchanges, and every message there and back."""

from __future__ import annotations

import itertools

import hypothesis
import pytest
from hypothesis import strategies as st

from aseba_vm.protocol import (
    MAX_PAYLOAD,
    ArrayAccessOutOfBounds,
    Command,
    Description,
    ExecutionStateChanged,
    FrameReader,
    GetDescription,
    GetNodeDescription,
    ListNodes,
    NodePresent,
    ProtocolError,
    Run,
    SetBytecode,
    SetVariables,
    UnknownMessage,
    UserMessage,
    Variables,
    decode,
    encode,
)
from tests.aseba_vm.protocol.strategies import SYSTEM, messages, of_kind

# Source: docs/spec/aseba-protocol.md section 1.4.
RECORDED = {
    "02 00 00 00 11 A0 05 00": ListNodes(0, 5),
    "02 00 00 00 00 A0 05 00": GetDescription(0, 5),
    "02 00 01 00 0C 90 05 00": NodePresent(1, 5),
    "04 00 00 00 10 A0 01 00 05 00": GetNodeDescription(0, 1, 5),
    "18 00 01 00 00 90 09 74 68 79 6D 69 6F 2D 49 49 05 00 FE 05 20 00 4A 02 1E 00 11 00 34 00": Description(
        1, "thymio-II", 5, 1534, 32, 586, 30, 17, 52
    ),
    "08 00 00 00 01 A0 01 00 00 00 03 00 FF FF": SetBytecode(0, 1, 0, (3, 0xFFFF)),
    "02 00 00 00 03 A0 01 00": Run(0, 1),
    "04 00 01 00 0A 90 1F 00 03 00": ExecutionStateChanged(1, 0x1F, 3),
    "04 00 01 00 02 00 FF FF 2C 01": UserMessage(1, 2, (-1, 300)),
    "06 00 01 00 05 90 0A 00 FE FF 2C 01": Variables(1, 10, (-2, 300)),
}


@pytest.mark.parametrize(("data", "message"), [(bytes.fromhex(text), message) for text, message in RECORDED.items()])
def test_recorded_frames(data, message):
    assert encode(message) == data
    assert decode(data) == message


@pytest.mark.parametrize("kind", SYSTEM)
def test_every_message_comes_back(kind):
    @hypothesis.given(of_kind(kind))
    @hypothesis.settings(max_examples=30)
    def check(message):
        hypothesis.assume(all(len(text.encode()) < 256 for text in vars_of(message) if isinstance(text, str)))
        assert decode(encode(message)) == message

    check()


def vars_of(message):
    return [getattr(message, name) for name in type(message).__dataclass_fields__]


def test_types_are_unique_and_complete():
    expected = {*range(0x8000, 0x8007), *range(0x9000, 0x900F), *range(0xA000, 0xA016)}
    assert sorted(kind.TYPE for kind in SYSTEM) == sorted(expected)
    assert all(issubclass(kind, Command) for kind in SYSTEM if 0xA001 <= kind.TYPE <= 0xA010)


@hypothesis.given(st.lists(messages, max_size=6), st.lists(st.integers(0, 400), max_size=8))
@hypothesis.settings(max_examples=200)
def test_a_stream_may_be_split_at_any_byte(sent, cuts):
    hypothesis.assume(all(fits(message) for message in sent))
    stream = b"".join(map(encode, sent))
    places = [0, *sorted(min(cut, len(stream)) for cut in cuts), len(stream)]
    reader = FrameReader()
    frames = [frame for start, end in itertools.pairwise(places) for frame in reader.feed(stream[start:end])]
    assert [decode(frame) for frame in frames] == sent
    assert reader.pending_bytes == 0


def fits(message):
    try:
        return bool(encode(message))
    except ProtocolError:
        return False


@hypothesis.given(st.binary(max_size=80))
def test_any_payload_of_any_type_is_a_message_or_a_protocol_error(payload):
    for number in (*(kind.TYPE for kind in SYSTEM), 0, 0x7FFF, 0xB000):
        frame = len(payload).to_bytes(2, "little") + b"\1\0" + number.to_bytes(2, "little") + payload
        assert outcome(frame) in (1, f"type 0x{number:04X}")


def outcome(frame):
    """The source of the message, or the type that the error names first."""
    try:
        return decode(frame).source
    except ProtocolError as error:
        return str(error)[:11]


def test_errors_name_what_was_found_and_expected():
    with pytest.raises(ProtocolError, match=r"0x9005 \(Variables\): payload of 1 bytes, expected at least 2"):
        decode(b"\1\0\1\0\5\x90\0")
    with pytest.raises(ProtocolError, match=r"type 0x9005: payload of 0 bytes, expected 4 by its header"):
        decode(b"\4\0\1\0\5\x90")
    with pytest.raises(ProtocolError, match="frame of 3 bytes"):
        decode(b"\1\0\1")
    with pytest.raises(ProtocolError, match="SetVariables: words"):
        encode(SetVariables(0, 1, 0, (40000,)))
    with pytest.raises(ProtocolError, match="NodePresent: value 70000"):
        encode(NodePresent(1, 70000))
    with pytest.raises(ProtocolError, match="number 32768"):
        encode(UserMessage(0, 32768))
    with pytest.raises(ProtocolError, match="source -1"):
        encode(Run(-1, 1))
    with pytest.raises(ProtocolError, match="payload of 80000 bytes"):
        encode(UserMessage(0, 1, (0,) * 40000))
    with pytest.raises(TypeError, match="Command has no type"):
        encode(Command(0, 1))


def test_words_that_peers_leave_out():
    assert decode(bytes.fromhex("00 00 00 00 11 A0")) == ListNodes(0, 5)
    assert decode(bytes.fromhex("02 00 01 00 06 90 21 00")) == ArrayAccessOutOfBounds(1, 0x21, 0, 0)
    assert len(encode(ArrayAccessOutOfBounds(1, 0x21))) == 12


def test_unknown_types_keep_their_payload():
    assert decode(bytes.fromhex("03 00 05 00 00 B0 01 02 03")) == UnknownMessage(5, 0xB000, b"\1\2\3")


def test_names_that_are_not_utf_8_are_read():
    assert decode(bytes.fromhex("05 00 01 00 01 90 01 00 02 FF 41")).name == "�A"


def test_a_payload_above_the_limit_is_refused():
    reader = FrameReader(MAX_PAYLOAD)
    assert reader.feed(encode(UserMessage(0, 1, (0,) * 258)))
    with pytest.raises(ProtocolError, match="payload of 518 bytes, expected at most 516"):
        reader.feed(encode(UserMessage(0, 1, (0,) * 259)))
