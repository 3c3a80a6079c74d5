"""Reads FlatBuffers tables from bytes of a client, which may contain anything.

The reader of the package `flatbuffers` trusts its buffer; this one checks each offset and length before use. A small
buffer can refer to the same bytes many times, so that it would unpack to gigabytes: `_MAX_UNPACKED` limits the bytes
read. Depth is limited by the declarations, none of which contains itself.
"""

from __future__ import annotations

import struct
from typing import Any
from uuid import UUID

from thymio_sim_ros.network.tdm.protocol.errors import TdmFrameError
from thymio_sim_ros.network.tdm.protocol.wire_types import Identifier, Octets, Scalar, Slot, Tables, Text, slots_of

__all__ = ["TableReader"]

_MAX_UNPACKED = 1 << 20
"""Bytes that may be read from one buffer, counting those read twice twice. The largest legal message has 102400."""

_U16 = struct.Struct("<H")
_U32 = struct.Struct("<I")
_I32 = struct.Struct("<i")
_NODE_ID_BYTES = 16


class TableReader:
    """The tables of one buffer. Every method raises TdmFrameError for what is outside the buffer or inconsistent."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._unread = _MAX_UNPACKED

    def root(self) -> int:
        """Position of the root table."""
        return self.follow(0, "root")

    def follow(self, position: int, where: str) -> int:
        """Position to which the offset at `position` points."""
        offset: int = self._number(_U32, position, where)
        if offset < 4:
            raise TdmFrameError(where, "an offset of 4 or more", str(offset))
        return position + offset

    def slot(self, table: int, number: int, where: str) -> int | None:
        """Position of the content of a slot of a table; None if the slot is absent."""
        vtable = table - self._number(_I32, table, where)
        size = self._number(_U16, vtable, where)
        if size < 4 or size % 2:
            raise TdmFrameError(where, "a vtable of 4 bytes or more, an even number", f"{size} bytes")
        entry = 4 + 2 * number
        if entry >= size:
            return None
        offset: int = self._number(_U16, vtable + entry, where)
        return table + offset if offset else None

    def scalar(self, wire: Scalar, position: int | None, where: str) -> Any:
        """A number, or its default if the slot is absent."""
        return wire.default if position is None else self._number(wire.layout, position, where)

    def table(self, kind: Any, position: int, where: str) -> Any:
        """A table as an object of the class that declares it."""
        values = {}
        for number, slot in enumerate(slots_of(kind)):
            place = f"{where}.{slot.name}"
            found = self.slot(position, number, place)
            values[slot.name] = self._value(slot, found, place)
        return kind(**values)

    def _value(self, slot: Slot, position: int | None, where: str) -> Any:
        match slot.wire:
            case Scalar():
                return self.scalar(slot.wire, position, where)
            case Text():
                return "" if position is None else self._text(position, where)
            case Octets():
                return b"" if position is None else self._octets(position, where)
            case Identifier():
                return None if position is None else self._identifier(position, where)
            case Tables():
                return () if position is None else self._tables(slot.wire.kind, position, where)

    def _text(self, position: int, where: str) -> str:
        raw = self._octets(position, where)
        try:
            return raw.decode()
        except UnicodeDecodeError as error:
            raise TdmFrameError(where, "text in UTF-8", f"byte {raw[error.start]:#04x}") from error

    def _octets(self, position: int, where: str) -> bytes:
        start, count = self._vector(position, 1, where)
        return self._data[start : start + count]

    def _identifier(self, position: int, where: str) -> UUID | None:
        found = self.slot(self.follow(position, where), 0, where)
        if found is None:
            return None
        raw = self._octets(found, where)
        if len(raw) != _NODE_ID_BYTES:
            raise TdmFrameError(where, f"{_NODE_ID_BYTES} bytes", f"{len(raw)}")
        return UUID(bytes=raw)

    def _tables(self, kind: type, position: int, where: str) -> tuple[Any, ...]:
        start, count = self._vector(position, 4, where)
        places = range(start, start + 4 * count, 4)
        return tuple(self.table(kind, self.follow(at, where), f"{where}[{i}]") for i, at in enumerate(places))

    def _vector(self, position: int, width: int, where: str) -> tuple[int, int]:
        """Position of the first element and number of elements of a vector."""
        start = self.follow(position, where)
        count = self._number(_U32, start, where)
        self._check(start + 4, count * width, where)
        return start + 4, count

    def _number(self, layout: struct.Struct, position: int, where: str) -> Any:
        self._check(position, layout.size, where)
        return layout.unpack_from(self._data, position)[0]

    def _check(self, position: int, size: int, where: str) -> None:
        if position < 0 or position + size > len(self._data):
            found = f"position {position} to {position + size}"
            raise TdmFrameError(where, f"a position in the {len(self._data)} bytes of the buffer", found)
        self._unread -= size
        if self._unread < 0:
            raise TdmFrameError(where, f"at most {_MAX_UNPACKED} bytes to read", "more, by offsets to the same bytes")
