"""Messages ↔ frames: bytes beside values, a round trip for every message, one error for every bad frame."""

from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from thymio_sim_ros.bridge import FrameError
from thymio_sim_ros.bridge.protocol import json_codec, wire
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol.constants import MAX_ID, StatusLevel
from thymio_sim_ros.bridge.protocol.messages import CLIENT_JSON, SERVER_JSON

IDS = st.integers(0, MAX_ID)
TEXTS = st.text(max_size=20)
SCALARS = st.booleans() | st.integers(-(2**63), 2**63) | st.floats(allow_nan=False, allow_infinity=False) | TEXTS

st.register_type_strategy(int, IDS)
st.register_type_strategy(str, TEXTS)
PARAMETERS = st.builds(
    ms.Parameter,
    name=TEXTS,
    value=st.none() | SCALARS | st.lists(SCALARS, max_size=3).map(tuple),
    type=st.none() | TEXTS,
)
st.register_type_strategy(ms.Parameter, PARAMETERS)

SERVER_BINARY = (
    st.builds(ms.MessageData, subscription_id=IDS, time_ns=st.integers(0, 2**64 - 1), payload=st.binary(max_size=40)),
    st.builds(ms.Time, time_ns=st.integers(0, 2**64 - 1)),
    st.builds(ms.ServiceResponse, payload=st.binary(max_size=40)),
    st.builds(ms.AssetResponse, data=st.binary(max_size=40), error=st.none()),
    st.builds(ms.AssetResponse, data=st.just(b""), error=TEXTS),
)
CLIENT_BINARY = (
    st.builds(ms.ClientMessageData, payload=st.binary(max_size=40)),
    st.builds(ms.ServiceRequest, payload=st.binary(max_size=40)),
)
SERVER = st.one_of(*(st.from_type(shape) for shape in SERVER_JSON), *SERVER_BINARY)
CLIENT = st.one_of(*(st.from_type(shape) for shape in CLIENT_JSON), *CLIENT_BINARY)


def decoded_or_refused(frame: str | bytes) -> ms.ClientMessage | str:
    """The message, or the text of the refusal; any other exception is a failure."""
    try:
        return wire.decode_client(frame)
    except FrameError as error:
        return str(error)


@given(SERVER)
def test_every_message_of_a_server_survives_the_wire(message: ms.ServerMessage) -> None:
    assert wire.decode_server(wire.encode_server(message)) == message


@given(CLIENT)
def test_every_message_of_a_client_survives_the_wire(message: ms.ClientMessage) -> None:
    assert wire.decode_client(wire.encode_client(message)) == message


@given(st.binary(max_size=60))
def test_any_bytes_give_a_message_or_one_precise_error(frame: bytes) -> None:
    assert decoded_or_refused(frame)


@given(CLIENT, st.data())
def test_a_frame_with_a_changed_character_gives_a_message_or_one_precise_error(
    message: Any, data: st.DataObject
) -> None:
    frame = wire.encode_client(message)
    at = data.draw(st.integers(0, len(frame) - 1))
    changed: str | bytes
    if isinstance(frame, str):
        changed = frame[:at] + data.draw(st.characters()) + frame[at + 1 :]
    else:
        changed = frame[:at] + bytes([data.draw(st.integers(0, 255))]) + frame[at + 1 :]
    assert decoded_or_refused(changed)


BYTES = [
    (ms.MessageData(7, 0x0102030405060708, b"xy"), "01 07000000 0807060504030201 7879"),
    (ms.Time(5), "02 0500000000000000"),
    (ms.ServiceResponse(1, 2, "cdr", b"z"), "03 01000000 02000000 03000000 636472 7a"),
    (ms.AssetResponse(3, b"mesh"), "04 03000000 00 00000000 6d657368"),
    (ms.AssetResponse(3, b"", "no"), "04 03000000 01 02000000 6e6f"),
]


@pytest.mark.parametrize(("message", "octets"), BYTES)
def test_binary_frames_of_the_server_have_these_bytes(message: ms.ServerMessage, octets: str) -> None:
    assert wire.encode_server(message) == bytes.fromhex(octets)


@pytest.mark.parametrize(
    ("message", "octets"),
    [
        (ms.ClientMessageData(9, b"hi"), "01 09000000 6869"),
        (ms.ServiceRequest(1, 2, "json", b"{}"), "02 01000000 02000000 04000000 6a736f6e 7b7d"),
    ],
)
def test_binary_frames_of_a_client_have_these_bytes(message: ms.ClientMessage, octets: str) -> None:
    assert wire.decode_client(bytes.fromhex(octets)) == message


TEXT_FRAMES: list[tuple[ms.ServerMessage, dict[str, Any]]] = [
    (
        ms.ServerInfo("x", ("time",), ("cdr",), {"k": "v"}, "s"),
        {
            "op": "serverInfo",
            "name": "x",
            "capabilities": ["time"],
            "supportedEncodings": ["cdr"],
            "metadata": {"k": "v"},
            "sessionId": "s",
        },
    ),
    (ms.Status(StatusLevel.ERROR, "bad", "i"), {"op": "status", "level": 2, "message": "bad", "id": "i"}),
    (ms.RemoveStatus(("i",)), {"op": "removeStatus", "statusIds": ["i"]}),
    (
        ms.Advertise((ms.Channel(1, "/t", "cdr", "p/msg/T", "int8 x", "ros2msg"),)),
        {
            "op": "advertise",
            "channels": [
                {
                    "id": 1,
                    "topic": "/t",
                    "encoding": "cdr",
                    "schemaName": "p/msg/T",
                    "schema": "int8 x",
                    "schemaEncoding": "ros2msg",
                }
            ],
        },
    ),
    (
        ms.ParameterValues((ms.Parameter("/n.p", 1.0, "float64"), ms.Parameter("/n.q"))),
        {"op": "parameterValues", "parameters": [{"name": "/n.p", "value": 1.0, "type": "float64"}, {"name": "/n.q"}]},
    ),
    (
        ms.ServiceCallFailure(1, 2, "gone"),
        {"op": "serviceCallFailure", "serviceId": 1, "callId": 2, "message": "gone"},
    ),
]


@pytest.mark.parametrize(("message", "expected"), TEXT_FRAMES)
def test_text_frames_have_these_keys_and_leave_out_what_is_absent(
    message: ms.ServerMessage, expected: dict[str, Any]
) -> None:
    assert json.loads(wire.encode_server(message)) == expected


@pytest.mark.parametrize(
    ("frame", "text"),
    [
        (b"", "binary frame: expected an opcode, found no bytes"),
        (b"\x09", "binary frame: expected opcode 1, 2, found opcode 9"),
        (b"\x01\x00", "message data: expected at least 5 bytes, found 2"),
        (b"\x02" + bytes(8) + b"\xff\xff\xff\xff", "service request: expected 4294967295 bytes of text, found 0"),
        (b"\x02" + bytes(8) + b"\x01\x00\x00\x00\xff", r"service request: expected UTF-8, found b'\xff'"),
        ("{", "text frame: expected JSON, found '{'"),
        ("[" * 100_000, f"text frame: expected JSON, found '{'[' * 39}…"),
        ("9" * 10_000, f"text frame: expected JSON, found '{'9' * 39}…"),
        ("[]", "text frame: expected an object, found []"),
        ('{"op":"subscribe"}', "subscribe: expected a key subscriptions, found none"),
        ('{"op":"subscribe","subscriptions":null}', "subscribe: expected a key subscriptions, found null"),
        ('{"op":"subscribe","subscriptions":{}}', "subscribe.subscriptions: expected a list, found {}"),
        (
            '{"op":"subscribe","subscriptions":[{"id":-1,"channelId":2}]}',
            "subscribe.subscriptions[0].id: expected an integer 0…4294967295, found -1",
        ),
        (
            '{"op":"unsubscribe","subscriptionIds":[true]}',
            "unsubscribe.subscriptionIds[0]: expected an integer 0…4294967295, found True",
        ),
        (
            '{"op":"setParameters","parameters":[{"name":"a","value":{}}]}',
            "setParameters.parameters[0].value: expected a number, a string, true or false, found {}",
        ),
        (
            '{"op":"setParameters","parameters":[{"name":"a","value":NaN}]}',
            "text frame: expected JSON numbers, found NaN",
        ),
        ('{"op":"fetchAsset","uri":1,"requestId":2}', "fetchAsset.uri: expected a string, found 1"),
    ],
)
def test_a_bad_frame_is_rejected_with_where_expected_and_found(frame: str | bytes, text: str) -> None:
    with pytest.raises(FrameError) as caught:
        wire.decode_client(frame)
    assert str(caught.value) == text


def test_an_unknown_op_is_rejected_with_the_known_ones() -> None:
    with pytest.raises(FrameError, match=r"expected op subscribe, .*fetchAsset, found 'dance'"):
        wire.decode_client('{"op":"dance"}')


def test_a_servers_status_level_must_be_a_known_one() -> None:
    with pytest.raises(FrameError, match=r"status.level: expected one of 0, 1, 2, found 3"):
        wire.decode_server('{"op":"status","level":3,"message":""}')


def test_unknown_keys_are_left_to_newer_peers() -> None:
    assert wire.decode_client('{"op":"unsubscribe","subscriptionIds":[1],"mood":"good"}') == ms.Unsubscribe((1,))


def test_text_that_utf8_cannot_encode_is_escaped() -> None:
    frame = wire.encode_server(ms.ParameterValues((), "\ud800"))
    assert isinstance(frame, str)
    assert frame.encode()


def test_the_hot_path_gives_the_frame_of_the_value() -> None:
    assert wire.data_head(7, 9) + b"p" == wire.encode_server(ms.MessageData(7, 9, b"p"))


def test_the_annotations_of_a_message_are_read_once() -> None:
    """They were read again for each message: ten times the work, while a client asked for all parameters."""
    assert json_codec.writer(ms.ParameterValues) is json_codec.writer(ms.ParameterValues)
