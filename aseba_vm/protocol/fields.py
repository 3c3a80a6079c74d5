"""Fields of payloads: how each kind of value is written to bytes and read from them.

Source: docs/spec/aseba-protocol.md section 1.3.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from typing import Annotated, Any, Protocol

from aseba_vm.protocol.errors import ProtocolError
from aseba_vm.target import Parameter

Range = tuple[int, tuple[int, ...]]


class Field(Protocol):
    """One kind of field."""

    def pack(self, value: Any) -> bytes:
        """The bytes of a value. Raises ProtocolError if the field cannot carry it."""

    def unpack(self, payload: bytes, offset: int) -> tuple[Any, int]:
        """The value at `offset` and the offset after it. Raises ProtocolError if bytes are missing."""


class _Integer:
    """An integer in a format of `struct`."""

    def __init__(self, code: str) -> None:
        self._struct = struct.Struct(f"<{code}")

    def pack(self, value: int) -> bytes:
        try:
            return self._struct.pack(value)
        except struct.error as error:
            raise ProtocolError(f"value {value!r}: {error}") from error

    def unpack(self, payload: bytes, offset: int) -> tuple[int, int]:
        end = offset + self._struct.size
        if end > len(payload):
            raise _missing(payload, end)
        return self._struct.unpack_from(payload, offset)[0], end


_U8, _U16, _I16 = _Integer("B"), _Integer("H"), _Integer("h")


class _Optional:
    """An integer that older or defective peers leave out: `default` where the payload ends before it."""

    def __init__(self, default: int, field: _Integer) -> None:
        self._default = default
        self._field = field

    def pack(self, value: int) -> bytes:
        return self._field.pack(value)

    def unpack(self, payload: bytes, offset: int) -> tuple[int, int]:
        if offset >= len(payload):
            return self._default, offset
        return self._field.unpack(payload, offset)


class _Bytes:
    """A count in `counter`, then that many bytes."""

    def __init__(self, counter: _Integer) -> None:
        self._counter = counter

    def pack(self, value: bytes) -> bytes:
        return self._counter.pack(len(value)) + value

    def unpack(self, payload: bytes, offset: int) -> tuple[bytes, int]:
        length, start = self._counter.unpack(payload, offset)
        end = start + length
        if end > len(payload):
            raise _missing(payload, end)
        return payload[start:end], end


class _Text:
    """A u8 count of bytes, then UTF-8 without a terminator; invalid bytes are read as the replacement character."""

    _bytes = _Bytes(_U8)

    def pack(self, value: str) -> bytes:
        try:
            return self._bytes.pack(value.encode())
        except UnicodeEncodeError as error:
            raise ProtocolError(f"text {value!r}: {error.reason}") from error

    def unpack(self, payload: bytes, offset: int) -> tuple[str, int]:
        value, end = self._bytes.unpack(payload, offset)
        return value.decode(errors="replace"), end


class _Words:
    """All words up to the end of the payload; a last odd byte is ignored."""

    def __init__(self, code: str) -> None:
        self._code = code

    def pack(self, value: Sequence[int]) -> bytes:
        try:
            return struct.pack(f"<{len(value)}{self._code}", *value)
        except struct.error as error:
            raise ProtocolError(f"words {tuple(value)!r}: {error}") from error

    def unpack(self, payload: bytes, offset: int) -> tuple[tuple[int, ...], int]:
        count = (len(payload) - offset) // 2
        return struct.unpack_from(f"<{count}{self._code}", payload, offset), offset + 2 * count


class _Fixed:
    """Exactly `size` bytes."""

    def __init__(self, size: int) -> None:
        self._size = size

    def pack(self, value: bytes) -> bytes:
        if len(value) != self._size:
            raise ProtocolError(f"{len(value)} bytes, expected {self._size}")
        return value

    def unpack(self, payload: bytes, offset: int) -> tuple[bytes, int]:
        end = offset + self._size
        if end > len(payload):
            raise _missing(payload, end)
        return payload[offset:end], end


class _Ranges:
    """Ranges of variables up to the end of the payload: (u16 start, u16 count, i16 values) each."""

    _words = _Words("h")

    def pack(self, value: Sequence[Range]) -> bytes:
        return b"".join(_U16.pack(start) + _U16.pack(len(values)) + self._words.pack(values) for start, values in value)

    def unpack(self, payload: bytes, offset: int) -> tuple[tuple[Range, ...], int]:
        ranges = []
        while offset < len(payload):
            start, offset = _U16.unpack(payload, offset)
            count, offset = _U16.unpack(payload, offset)
            end = offset + 2 * count
            if end > len(payload):
                raise _missing(payload, end)
            ranges.append((start, self._words.unpack(payload[offset:end], 0)[0]))
            offset = end
        return tuple(ranges), offset


class _Parameters:
    """A u16 count, then (i16 size, text name) of each parameter of a native function."""

    _text = _Text()

    def pack(self, value: Sequence[Parameter]) -> bytes:
        items = (_I16.pack(parameter.size) + self._text.pack(parameter.name) for parameter in value)
        return _U16.pack(len(value)) + b"".join(items)

    def unpack(self, payload: bytes, offset: int) -> tuple[tuple[Parameter, ...], int]:
        count, offset = _U16.unpack(payload, offset)
        parameters = []
        for _ in range(count):
            size, offset = _I16.unpack(payload, offset)
            name, offset = self._text.unpack(payload, offset)
            parameters.append(Parameter(name, size))
        return tuple(parameters), offset


def _missing(payload: bytes, expected: int) -> ProtocolError:
    return ProtocolError(f"payload of {len(payload)} bytes, expected at least {expected}")


# The kinds of fields that messages declare.
U8 = Annotated[int, _U8]
U16 = Annotated[int, _U16]
I16 = Annotated[int, _I16]
#: A version that is missing in requests of the oldest clients is the one of Aseba 1.6.
Version = Annotated[int, _Optional(5, _U16)]
#: A word that some nodes leave out at the end; 0 then.
OptionalU16 = Annotated[int, _Optional(0, _U16)]
OptionalI16 = Annotated[int, _Optional(0, _I16)]
Text = Annotated[str, _Text()]
#: Values of variables and arguments of events, -32768..32767.
WORDS = _Words("h")
Words = Annotated[tuple[int, ...], WORDS]
#: Words of bytecode, 0..65535.
Code = Annotated[tuple[int, ...], _Words("H")]
FourBytes = Annotated[bytes, _Fixed(4)]
Bytes8 = Annotated[bytes, _Bytes(_U8)]
Bytes16 = Annotated[bytes, _Bytes(_U16)]
Ranges = Annotated[tuple[Range, ...], _Ranges()]
Parameters = Annotated[tuple[Parameter, ...], _Parameters()]
