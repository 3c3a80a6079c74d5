"""WebSocket frames as a server sends them: whole messages, unmasked (RFC 6455 section 5.2).

`websockets` would write the same bytes, but its state belongs to the event loop, and building a frame takes it longer
than the kernel needs to send it. It still does handshakes, reading, pings and the end of connections.
"""

from __future__ import annotations

import struct

from thymio_sim_ros.bridge.protocol.constants import BinaryOpcode
from thymio_sim_ros.bridge.protocol.wire import DATA_HEAD_SIZE, data_head

__all__ = ["binary_head", "data_frame", "framed"]

_TEXT = 0x81
_BINARY = 0x82
"""Opcode with the FIN bit, 0x80: the message ends with this frame."""

_MESSAGE_DATA = int(BinaryOpcode.MESSAGE_DATA)

_SHORT = struct.Struct("!BB")
_MEDIUM = struct.Struct("!BBH")
_LONG = struct.Struct("!BBQ")
_MEDIUM_DATA = struct.Struct("<BBBBBIQ")
"""WebSocket header and message header in one call. The length is packed as two single bytes because it is big-endian
and the message header is little-endian."""


def binary_head(size: int) -> bytes:
    """The WebSocket header of a binary message of `size` bytes."""
    return _head(_BINARY, size)


def data_frame(subscription_id: int, time_ns: int, payload: bytes) -> bytes:
    """The frame of a `MessageData`. Hot path: sizes of 126 to 65535 bytes, which most messages have, take one call."""
    size = DATA_HEAD_SIZE + len(payload)
    if 126 <= size < 1 << 16:
        return (
            _MEDIUM_DATA.pack(_BINARY, 126, size >> 8, size & 0xFF, _MESSAGE_DATA, subscription_id, time_ns) + payload
        )
    return binary_head(size) + data_head(subscription_id, time_ns) + payload


def framed(message: str | bytes) -> bytes:
    """The frame of a whole message."""
    if isinstance(message, str):
        body = message.encode()
        return _head(_TEXT, len(body)) + body
    return binary_head(len(message)) + message


def _head(opcode: int, size: int) -> bytes:
    if size < 126:
        return _SHORT.pack(opcode, size)
    if size < 1 << 16:
        return _MEDIUM.pack(opcode, 126, size)
    return _LONG.pack(opcode, 127, size)
