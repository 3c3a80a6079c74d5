"""Frames of a stream: u16 payload length, u16 source, u16 type, payload; all little-endian.

Source: docs/spec/aseba-protocol.md section 1.1.
"""

from __future__ import annotations

from aseba_vm.protocol.errors import ProtocolError

HEADER_SIZE = 6
#: Maximum payload in bytes that every peer accepts.
MAX_PAYLOAD = 516
#: Maximum payload in bytes that the length field can state.
LARGEST_PAYLOAD = 0xFFFF


class FrameReader:
    """Cuts the bytes of one stream into frames; the stream may be split at any byte."""

    def __init__(self, max_payload: int = LARGEST_PAYLOAD) -> None:
        """`max_payload` is the longest accepted payload in bytes."""
        self._max_payload = max_payload
        self._pending = bytearray()

    @property
    def pending_bytes(self) -> int:
        """Number of bytes of a frame that is not complete yet."""
        return len(self._pending)

    def feed(self, data: bytes) -> list[bytes]:
        """The frames that `data` completes, each with its header.

        Raises ProtocolError for a payload above the limit; the stream cannot be read further, so close it. Frames
        before it in the same `data` are lost.
        """
        self._pending += data
        pending = self._pending
        frames = []
        start = 0
        while len(pending) - start >= HEADER_SIZE:
            length = pending[start] | pending[start + 1] << 8
            if length > self._max_payload:
                pending.clear()
                raise ProtocolError(f"frame: payload of {length} bytes, expected at most {self._max_payload}")
            end = start + HEADER_SIZE + length
            if len(pending) < end:
                break
            frames.append(bytes(pending[start:end]))
            start = end
        del pending[:start]
        return frames
