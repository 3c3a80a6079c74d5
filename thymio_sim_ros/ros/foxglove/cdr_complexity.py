"""Limits the cost of deserialization: a long message must not consist of very many small parts.

rclpy holds the interpreter lock while it creates the Python objects of a message: 4 MB of markers take 1.3 s, 4 MB of
numbers 1 ms. A long message of a type with sequences of messages or strings is therefore scanned first: a scanner,
built from the fields of the type, moves over the CDR bytes and counts parts, without creating objects.

Rules of CDR (XCDR1, little endian) that the scanner follows: four bytes of header; a number is aligned to its size,
counted from the end of the header; a sequence and a string begin with an aligned uint32 with their length; messages
have no alignment of their own.
"""

from __future__ import annotations

import functools
import re
import struct
from collections.abc import Callable
from typing import Any

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.ros.foxglove.types import MissingTypeError, full_name, load_type

__all__ = ["MAX_PARTS", "UNCHECKED_BYTES", "TooManyPartsError", "check_parts"]

UNCHECKED_BYTES = 256 << 10
"""Shorter messages are not checked: any of them is deserialized in less than 0.1 s."""

MAX_PARTS = 10_000
"""Largest number of nested messages and strings in a longer one."""

_LITTLE_ENDIAN_CDR = b"\x00\x01"
_HEAD = 4
_COUNT = struct.Struct("<I")
_SIZES = {
    **dict.fromkeys(("boolean", "octet", "char", "int8", "uint8", "byte"), 1),
    **{f"{sign}int{bits}": bits // 8 for sign in ("", "u") for bits in (8, 16, 32, 64)},
    "float": 4,
    "double": 8,
}
_SEQUENCE = re.compile(r"^sequence<([^,]+)(?:, \d+)?>$")
_ARRAY = re.compile(r"^(.+)\[(\d+)\]$")
_STRING = re.compile(r"^string(?:<\d+>)?$")


class TooManyPartsError(ThymioSimError, ValueError):
    """Deserialization of a message would take too long."""

    def __init__(self) -> None:
        super().__init__(f"a message of more than {UNCHECKED_BYTES} bytes may have at most {MAX_PARTS} parts")


class _Scan:
    """A position in a serialized message, and the number of parts before it."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._at = _HEAD
        self._parts = 0

    def part(self) -> None:
        """Count a message or a string. Raises TooManyPartsError above the limit."""
        self._parts += 1
        if self._parts > MAX_PARTS:
            raise TooManyPartsError

    def skip(self, size: int, count: int = 1) -> None:
        """Move behind `count` numbers of `size` bytes each, the first of them aligned."""
        if count:
            self._at += -(self._at - _HEAD) % size + size * count

    def count(self) -> int:
        """Read a length."""
        self.skip(4)
        return int(_COUNT.unpack_from(self._data, self._at - 4)[0])


_Step = Callable[[_Scan], None]


def check_parts(data: bytes, message_type: Any) -> None:
    """Raise TooManyPartsError if the deserialization of a message would take too long.

    Invalid bytes are accepted: deserialization rejects them quickly.
    """
    if len(data) <= UNCHECKED_BYTES:
        return
    try:
        step = _message(message_type)
    except (MissingTypeError, AttributeError, KeyError):  # an unusual type that the scanner does not support
        raise TooManyPartsError from None
    if step is None:
        return
    if not data.startswith(_LITTLE_ENDIAN_CDR):
        raise TooManyPartsError
    try:
        step(_Scan(data))
    except struct.error:
        return  # too short: deserialization rejects it


@functools.cache
def _message(message_type: Any) -> _Step | None:
    """Build the scanner of a message type; None if messages of the type have a fixed number of parts.

    Raises MissingTypeError, AttributeError or KeyError for a type with unsupported fields.
    """
    kinds = list(message_type.get_fields_and_field_types().values())
    steps = [_field(kind) for kind in kinds] or [_numbers("uint8", 1)]
    if not any(_has_many_parts(kind) for kind in kinds):
        return None
    return _all_of(steps)


def _has_many_parts(kind: str) -> bool:
    sequence, array = _SEQUENCE.match(kind), _ARRAY.match(kind)
    if sequence is not None:
        return sequence[1] not in _SIZES
    if array is not None:
        return _has_many_parts(array[1])
    return "/" in kind and _message(load_type(full_name(kind))) is not None


def _all_of(steps: list[_Step]) -> _Step:
    def scan(at: _Scan) -> None:
        at.part()
        for step in steps:
            step(at)

    return scan


@functools.cache
def _field(kind: str) -> _Step:
    sequence, array = _SEQUENCE.match(kind), _ARRAY.match(kind)
    if sequence is not None:
        return _items(sequence[1], None)
    if array is not None:
        return _items(array[1], int(array[2]))
    if _STRING.match(kind):
        return _text
    if "/" in kind:
        fields = load_type(full_name(kind)).get_fields_and_field_types()
        return _all_of([_field(item) for item in fields.values()] or [_numbers("uint8", 1)])
    return _numbers(kind, 1)


def _items(kind: str, count: int | None) -> _Step:
    if kind in _SIZES:
        return _numbers(kind, count)
    item = _field(kind)

    def scan(at: _Scan) -> None:
        for _ in range(at.count() if count is None else count):
            item(at)

    return scan


def _numbers(kind: str, count: int | None) -> _Step:
    size = _SIZES[kind]
    return lambda at: at.skip(size, at.count() if count is None else count)


def _text(at: _Scan) -> None:
    at.part()
    at.skip(1, at.count())
