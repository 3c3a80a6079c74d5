"""Declares the slots of a FlatBuffers table as fields of a frozen dataclass, in the order of the slots.

The helpers are default values of fields: `line: int = u32()`. `slots_of` returns the declarations of a class;
`reader` and `writer` walk them, so that no code is generated from a schema.
"""

from __future__ import annotations

import struct
from dataclasses import Field, dataclass, field, fields
from functools import cache
from typing import Any

from flatbuffers import number_types

__all__ = [
    "Identifier",
    "Octets",
    "Scalar",
    "Slot",
    "Tables",
    "Text",
    "boolean",
    "f64",
    "i16",
    "i32",
    "identifier",
    "octets",
    "slots_of",
    "string",
    "tables",
    "u8",
    "u16",
    "u32",
    "u64",
]

_WIRE = "wire"
"""Key of a field's metadata."""


@dataclass(frozen=True, slots=True)
class Scalar:
    """A number or a truth value inside the table; absent: `default`."""

    layout: struct.Struct
    flags: Any
    """Its type for the builder of `flatbuffers`."""
    default: float


@dataclass(frozen=True, slots=True)
class Text:
    """A string in UTF-8; absent: empty."""


@dataclass(frozen=True, slots=True)
class Octets:
    """A vector of bytes; absent: empty."""


@dataclass(frozen=True, slots=True)
class Identifier:
    """A table with the 16 bytes of a UUID in its only slot; absent: None."""


@dataclass(frozen=True, slots=True)
class Tables:
    """A vector of tables; absent: empty."""

    kind: type


Wire = Scalar | Text | Octets | Identifier | Tables


@dataclass(frozen=True, slots=True)
class Slot:
    """A field of a message with its form in a buffer."""

    name: str
    wire: Wire


@cache
def slots_of(kind: Any) -> tuple[Slot, ...]:
    """The slots of a table, in order."""
    return tuple(Slot(part.name, _wire_of(part)) for part in fields(kind))


def _wire_of(part: Field[Any]) -> Wire:
    wire: Wire = part.metadata[_WIRE]
    return wire


def _scalar(layout: str, flags: Any, default: float) -> Any:
    return field(default=default, metadata={_WIRE: Scalar(struct.Struct(layout), flags, default)})


def u8(default: int = 0) -> Any:
    """Slot of an unsigned integer of 8 bits."""
    return _scalar("<B", number_types.Uint8Flags, default)


def u16(default: int = 0) -> Any:
    """Slot of an unsigned integer of 16 bits."""
    return _scalar("<H", number_types.Uint16Flags, default)


def u32(default: int = 0) -> Any:
    """Slot of an unsigned integer of 32 bits."""
    return _scalar("<I", number_types.Uint32Flags, default)


def u64(default: int = 0) -> Any:
    """Slot of an unsigned integer of 64 bits."""
    return _scalar("<Q", number_types.Uint64Flags, default)


def i16(default: int = 0) -> Any:
    """Slot of a signed integer of 16 bits."""
    return _scalar("<h", number_types.Int16Flags, default)


def i32(default: int = 0) -> Any:
    """Slot of a signed integer of 32 bits."""
    return _scalar("<i", number_types.Int32Flags, default)


def f64(default: float = 0.0) -> Any:
    """Slot of a floating-point number of 64 bits."""
    return _scalar("<d", number_types.Float64Flags, default)


def boolean(*, default: bool = False) -> Any:
    """Slot of a truth value."""
    return _scalar("<?", number_types.BoolFlags, default)


def string() -> Any:
    """Slot of a string."""
    return field(default="", metadata={_WIRE: Text()})


def octets() -> Any:
    """Slot of a vector of bytes."""
    return field(default=b"", metadata={_WIRE: Octets()})


def identifier() -> Any:
    """Slot of a UUID."""
    return field(default=None, metadata={_WIRE: Identifier()})


def tables(kind: type) -> Any:
    """Slot of a vector of tables."""
    return field(default=(), metadata={_WIRE: Tables(kind)})
