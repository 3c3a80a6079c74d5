"""Operations of rosbridge as WebSocket messages: JSON in text, CBOR in binary ones (docs/rosbridge.md)."""

from __future__ import annotations

import base64
import json
import math
import struct
import zlib
from collections.abc import Mapping
from typing import Any

import cbor2

from thymio_sim_ros.bridge.protocol import bounded_json
from thymio_sim_ros.bridge.protocol.errors import FrameError
from thymio_sim_ros.bridge.rosbridge import bounded_cbor

__all__ = ["Operation", "as_cbor", "as_json", "as_png", "decode", "status"]

Operation = Mapping[str, Any]
"""The object of an operation; its key `op` has the name."""


def decode(frame: str | bytes) -> dict[str, Any]:
    """Decode an operation. Raises FrameError for anything but an object with the text `op`."""
    is_text = isinstance(frame, str) or frame[:1] in (b"{", b" ", b"\n")  # some clients send JSON as bytes
    try:
        value = bounded_json.loads(_text(frame)) if is_text else bounded_cbor.loads(bytes(frame))  # type: ignore[arg-type]
    except (ValueError, RecursionError) as error:
        raise FrameError("message", "an operation in JSON or CBOR", f"{_start(frame)}: {error}") from error
    if not isinstance(value, dict):
        raise FrameError("message", 'an object with the key "op"', _start(frame))
    if not isinstance(value.get("op"), str):
        raise FrameError("op", "the name of an operation", f"{value.get('op')!r:.40}")
    return value


def as_json(operation: Operation) -> str:
    """Encode an operation as text. Its numbers must be finite."""
    return json.dumps(operation, allow_nan=False, separators=(",", ":"))


def as_cbor(operation: Operation) -> bytes:
    """Encode an operation as bytes."""
    return cbor2.dumps(operation)


def as_png(text: str) -> str:
    """A text as the pixels of a PNG picture, in base64: rows of RGB, filled up with line breaks."""
    data = text.encode()
    width = max(1, math.isqrt(len(data) // 3))
    row = 3 * width
    height = -(-len(data) // row)
    rows = data.ljust(row * height, b"\n")
    pixels = b"".join(b"\0" + rows[at : at + row] for at in range(0, len(rows), row))  # filter 0 in each row
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)  # 8 bits, RGB
    chunks = ((b"IHDR", head), (b"IDAT", zlib.compress(pixels)), (b"IEND", b""))
    body = b"".join(_chunk(kind, content) for kind, content in chunks)
    return base64.b64encode(b"\x89PNG\r\n\x1a\n" + body).decode()


def _chunk(kind: bytes, content: bytes) -> bytes:
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def status(level: str, text: str, operation_id: object = None) -> dict[str, Any]:
    """A status for the client: `level` is `error`, `warning` or `info`; with the ID of the operation that caused it."""
    given = {} if operation_id is None else {"id": operation_id}
    return {"op": "status", "level": level, "msg": text, **given}


def _text(frame: str | bytes) -> str:
    return frame if isinstance(frame, str) else frame.decode()


def _start(frame: str | bytes) -> str:
    return f"{frame[:40]!r}"
