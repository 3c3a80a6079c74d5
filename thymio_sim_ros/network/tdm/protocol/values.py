"""Values of variables and arguments of events: FlexBuffers of 16-bit integers.

Source: docs/spec/aseba-protocol.md section 2.2, "FlexBuffer values".
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from functools import lru_cache

from flatbuffers import flexbuffers

from thymio_sim_ros.network.tdm.protocol.errors import ValueTypeError

__all__ = ["MAX_WORDS", "NO_VALUE", "decode_value", "encode_value"]

MAX_WORDS = 4096
"""Longest value that is accepted; no memory of a node is that long."""

_LOWEST, _HIGHEST = -0x8000, 0xFFFF


_INT, _VECTOR, _W8, _W16 = 1 << 2, 10 << 2, 0, 1
"""Types of FlexBuffers, and widths of 1 and 2 bytes, which the low bits of a type contain."""

NO_VALUE = b"\0\0\1"
"""The value of a variable that no longer exists: null."""


@lru_cache(maxsize=4096)
def encode_value(words: tuple[int, ...]) -> bytes:
    """The buffer of words (int16): always an untyped vector, the only form that all clients read.

    It has the length, the words, the type of each word, and the offset back to the first word; the root's type and
    width follow. The result is that of `flexbuffers.Dumps(list(words))`, which takes a hundred times as long.
    """
    count = len(words)
    is_narrow = count < 0x100 and all(-0x80 <= word < 0x80 for word in words)
    letter, width = ("b", _W8) if is_narrow else ("h", _W16)
    size = 1 << width
    body = struct.pack(f"<{letter.upper()}{count}{letter}", count, *words) + bytes([_INT | width]) * count
    back = len(body) - size
    if back < 0x100:
        return body + bytes((back, _VECTOR | width, 1))
    body += b"\0" * (len(body) % 2)
    return body + struct.pack("<HBB", len(body) - size, _VECTOR | width, 2)


def decode_value(buffer: bytes) -> tuple[int, ...]:
    """The words (int16) of a buffer: an integer, a vector of integers, or null for none.

    Unsigned 16-bit numbers become signed ones. Raises ValueTypeError for any other buffer.
    """
    if len(buffer) < 3:  # a value, its type and its width
        raise ValueTypeError(f"value: found {len(buffer)} bytes, expected 3 or more")
    try:
        return tuple(_signed(number) for number in _numbers(flexbuffers.GetRoot(buffer)))
    except (IndexError, KeyError, TypeError, ValueError, ZeroDivisionError, OverflowError, struct.error) as error:
        raise ValueTypeError(f"value: found {buffer[:16].hex(' ')}, expected a FlexBuffer of integers") from error


def _numbers(root: flexbuffers.Ref) -> Sequence[int]:
    if root.IsNull:
        return ()
    if root.IsInt:
        return (root.AsInt,)
    if root.IsMap:
        raise TypeError("a map")
    if root.IsFixedTypedVector:
        vector = root.AsFixedTypedVector
    else:
        vector = root.AsTypedVector if root.IsTypedVector else root.AsVector
    if len(vector) > MAX_WORDS:
        raise ValueError(f"{len(vector)} words")
    # A vector in a vector is not read: it could contain itself.
    if not all(element.IsInt for element in vector):
        raise TypeError("an element is not an integer")
    return [element.AsInt for element in vector]


def _signed(number: int) -> int:
    if not _LOWEST <= number <= _HIGHEST:
        raise ValueError(f"{number} has more than 16 bits")
    return (number + 0x8000) % 0x10000 - 0x8000
