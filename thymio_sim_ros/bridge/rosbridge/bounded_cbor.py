"""Decoding of untrusted CBOR (RFC 8949) at a bounded cost, as `protocol.bounded_json` does it for JSON.

Each item of a message becomes an object of Python: a megabyte of empty lists takes 0.3 s to decode, during which no
other thread can run. The heads of the items are therefore scanned first. Byte strings of any length are one item.
"""

from __future__ import annotations

from typing import Any

import cbor2

__all__ = ["MAX_ITEMS", "loads"]

MAX_ITEMS = 10_000
"""Numbers, texts, byte strings, lists and maps of a message."""

_BYTES, _TEXT, _LIST, _MAP, _TAG = 2, 3, 4, 5, 6
"""Major types (RFC 8949 section 3.1)."""
_LONG, _RESERVED = 24, 28
"""From these values on, the low bits of a head are not the argument itself (section 3)."""


def loads(data: bytes) -> Any:
    """Decode a message without tags and indefinite lengths. Raises ValueError for any other."""
    _check(data)
    try:
        return cbor2.loads(data)
    except (cbor2.CBORDecodeError, RecursionError, TypeError, UnicodeDecodeError) as error:
        raise ValueError(str(error)) from error


def _check(data: bytes) -> None:
    """Raise ValueError if a message is too short or too long for its items, or has too many."""
    at, items, due = 0, 0, 1  # `due`: items that must follow
    while due:
        if at >= len(data):
            raise ValueError(f"expected {due} more items, found the end after {len(data)} bytes")
        kind, argument = data[at] >> 5, data[at] & 0x1F
        at, items, due = at + 1, items + 1, due - 1
        if argument >= _RESERVED or kind == _TAG:
            raise ValueError(f"byte {at - 1}: expected no tag and no indefinite length, found {data[at - 1]:#04x}")
        if argument >= _LONG:
            size = 1 << (argument - _LONG)
            argument, at = int.from_bytes(data[at : at + size]), at + size
        if kind in (_BYTES, _TEXT):
            at += argument
        elif kind in (_LIST, _MAP):
            due += argument * (1 if kind == _LIST else 2)
        if items + due > MAX_ITEMS:
            raise ValueError(f"more than {MAX_ITEMS} items")
    if at != len(data):
        raise ValueError(f"expected {at} bytes, found {len(data)}")
