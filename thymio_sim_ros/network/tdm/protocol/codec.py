"""Bytes ↔ messages of the Thymio Device Manager, and the frames of a TCP stream.

Source: docs/spec/aseba-protocol.md sections 2.1 and 2.2.
"""

from __future__ import annotations

import struct

from thymio_sim_ros.network.tdm.protocol.errors import TdmFrameError
from thymio_sim_ros.network.tdm.protocol.messages import MESSAGES, Message
from thymio_sim_ros.network.tdm.protocol.reader import TableReader
from thymio_sim_ros.network.tdm.protocol.wire_types import Scalar
from thymio_sim_ros.network.tdm.protocol.writer import write_union

__all__ = ["MAX_MESSAGE_BYTES", "StreamReader", "decode", "encode", "framed"]

MAX_MESSAGE_BYTES = 102400
"""Largest message; both sides state it in the handshake."""

_LENGTH = struct.Struct("<I")
_TYPE, _CONTENT = 0, 1
"""Slots of the root table."""
_NUMBERS = {kind: number for number, kind in enumerate(MESSAGES, 1)}
_U8 = Scalar(struct.Struct("<B"), None, 0)


def encode(message: Message) -> bytes:
    """The buffer of a message, without a length in front."""
    return write_union(_NUMBERS[type(message)], message)


def framed(buffer: bytes) -> bytes:
    """A buffer as it travels by TCP."""
    return _LENGTH.pack(len(buffer)) + buffer


def decode(buffer: bytes) -> Message:
    """The message of a buffer. Raises TdmFrameError for anything else."""
    if len(buffer) > MAX_MESSAGE_BYTES:
        raise TdmFrameError("buffer", f"at most {MAX_MESSAGE_BYTES} bytes", str(len(buffer)))
    reader = TableReader(buffer)
    root = reader.root()
    number: int = reader.scalar(_U8, reader.slot(root, _TYPE, "message_type"), "message_type")
    if not 1 <= number <= len(MESSAGES):
        raise TdmFrameError("message_type", f"1 to {len(MESSAGES)}", str(number))
    kind = MESSAGES[number - 1]
    content = reader.slot(root, _CONTENT, "message")
    if content is None:
        return kind()
    message: Message = reader.table(kind, reader.follow(content, "message"), kind.__name__)
    return message


class StreamReader:
    """Cuts a TCP stream into buffers. Invariant: holds less than one message and its length."""

    def __init__(self) -> None:
        self._pending = bytearray()

    def feed(self, data: bytes) -> list[bytes]:
        """The buffers that `data` completes. Raises TdmFrameError for a length above the limit."""
        self._pending += data
        buffers = []
        while len(self._pending) >= _LENGTH.size:
            (length,) = _LENGTH.unpack_from(self._pending)
            if length > MAX_MESSAGE_BYTES:
                raise TdmFrameError("length", f"at most {MAX_MESSAGE_BYTES} bytes", str(length))
            end = _LENGTH.size + length
            if len(self._pending) < end:
                break
            buffers.append(bytes(self._pending[_LENGTH.size : end]))
            del self._pending[:end]
        return buffers
