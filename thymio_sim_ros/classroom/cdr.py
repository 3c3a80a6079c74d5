"""The few messages of a suite that the class reads, from their CDR bytes (little-endian). Pure."""

from __future__ import annotations

import struct

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["CdrError", "read_diagnostic", "read_string"]

_HEADER = b"\x00\x01\x00\x00"
_MAX_PAIRS = 200


class CdrError(ThymioSimError, ValueError):
    """Bytes that are not the expected message."""


class _Reader:
    def __init__(self, payload: bytes) -> None:
        if payload[:2] != _HEADER[:2]:
            raise CdrError(f"expected little-endian CDR, found {payload[:4].hex()}")
        self._data, self._at = payload[4:], 0

    def skip_byte(self) -> None:
        self._at += 1

    def uint32(self) -> int:
        self._at += -self._at % 4
        try:
            (value,) = struct.unpack_from("<I", self._data, self._at)
        except struct.error as error:
            raise CdrError("expected more bytes") from error
        self._at += 4
        return int(value)

    def string(self) -> str:
        size = self.uint32()
        data = self._data[self._at : self._at + size]
        if len(data) != size or not data.endswith(b"\0"):
            raise CdrError("expected a string")
        self._at += size
        return data[:-1].decode("utf-8", "replace")


def read_string(payload: bytes) -> str:
    """The text of a std_msgs/String. Raises CdrError."""
    return _Reader(payload).string()


def read_diagnostic(payload: bytes) -> dict[str, str]:
    """Keys and values of a diagnostic_msgs/DiagnosticStatus. Raises CdrError."""
    reader = _Reader(payload)
    reader.skip_byte()  # level
    for _ in ("name", "message", "hardware_id"):
        reader.string()
    count = reader.uint32()
    if count > _MAX_PAIRS:
        raise CdrError(f"found {count} values, expected at most {_MAX_PAIRS}")
    return {reader.string(): reader.string() for _ in range(count)}
