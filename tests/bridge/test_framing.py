"""Our frames beside those of `websockets`."""

from __future__ import annotations

import pytest
from websockets.frames import Frame, Opcode

from thymio_sim_ros.bridge.framing import binary_head, framed

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
