"""Our frames beside those of `websockets`."""

from __future__ import annotations

import pytest
from websockets.frames import Frame, Opcode

from thymio_sim_ros.bridge.framing import binary_head, data_frame, framed
from thymio_sim_ros.bridge.protocol.messages import MessageData
from thymio_sim_ros.bridge.protocol.wire import encode_server

SIZES = [0, 1, 125, 126, 127, 65535, 65536, 100_000]


@pytest.mark.parametrize("size", SIZES)
def test_a_binary_message_is_framed_as_websockets_does_it(size: int) -> None:
    data = bytes(number % 251 for number in range(size))
    expected = Frame(Opcode.BINARY, data).serialize(mask=False)
    assert framed(data) == expected
    assert binary_head(size) + data == expected


@pytest.mark.parametrize("text", ["", "{}", "ä" * 63, "ä" * 62 + "a", "∞" * 30_000])
def test_a_text_is_framed_by_its_bytes(text: str) -> None:
    assert framed(text) == Frame(Opcode.TEXT, text.encode()).serialize(mask=False)


@pytest.mark.parametrize("size", [0, 112, 113, 114, 1000, 65522, 65523, 65524, 100_000])
@pytest.mark.parametrize(("subscription", "time_ns"), [(1, 0), (2**32 - 1, 2**64 - 1)])
def test_the_frame_of_data_is_its_message_framed(size: int, subscription: int, time_ns: int) -> None:
    payload = bytes(number % 251 for number in range(size))
    message = MessageData(subscription, time_ns, payload)
    assert data_frame(subscription, time_ns, payload) == framed(encode_server(message))
