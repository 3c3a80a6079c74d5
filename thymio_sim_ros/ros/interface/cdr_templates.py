"""Templates: messages that are serialized once and patched with each reading, at a third of the cost of serializing.

In CDR, fields of fixed size keep their place as long as texts and arrays keep their length: the stamp of a header is at
the beginning, numbers are at a fixed distance from the end. A row of `sensor_topics` describes them by a `Patch`; each
template is compared with the result of the serializer when it is created.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from rclpy.serialization import deserialize_message, serialize_message

from thymio_sim_ros.ros.interface.headers import SECOND_NS

__all__ = ["Patch", "Span", "Template"]

_STAMP = struct.Struct("<iI")
_STAMP_AT = 4
"""Offset of the stamp in bytes: it follows the encapsulation header."""


@dataclass(frozen=True, slots=True)
class Span:
    """Adjacent numbers, packed by `layout`, that end `behind` bytes before the end of the message."""

    layout: struct.Struct
    numbers: Callable[[Any, Any], Sequence[float]]
    behind: int = 0


@dataclass(frozen=True, slots=True)
class Patch:
    """The parts of a message that a reading changes: spans, and the stamp if there is one."""

    spans: tuple[Span, ...]
    has_stamp: bool = True


class Template:
    """The serialized message of one topic, valid for one object of options."""

    __slots__ = ("_data", "_has_stamp", "_spans", "options")

    def __init__(self, patch: Patch, message: Any, options: Any) -> None:
        self.options = options
        self._has_stamp = patch.has_stamp
        self._data = bytearray(serialize_message(message))
        size = len(self._data)
        self._spans = [
            (span.layout.pack_into, size - span.behind - span.layout.size, span.numbers) for span in patch.spans
        ]

    @classmethod
    def checked(cls, patch: Patch, message: Any, reading: Any, options: Any) -> Template | None:
        """Return the template of a message; None if patching it with its own reading gives another message."""
        template = cls(patch, message, options)
        # Padding is arbitrary, so messages are compared instead of bytes; by their text, since NaN differs from NaN.
        try:
            filled = deserialize_message(template.fill(reading), type(message))
        except (RuntimeError, struct.error):  # a length was overwritten, or there is no room
            return None
        fresh = deserialize_message(serialize_message(message), type(message))
        return template if repr(filled) == repr(fresh) else None

    def at(self, stamp_ns: int) -> bytes:
        """Return the message with this stamp; everything else stays."""
        _STAMP.pack_into(self._data, _STAMP_AT, *divmod(stamp_ns, SECOND_NS))
        return bytes(self._data)

    def fill(self, reading: Any) -> bytes:
        """Return the message of a reading."""
        data = self._data
        if self._has_stamp:
            _STAMP.pack_into(data, _STAMP_AT, *divmod(reading.stamp_ns, SECOND_NS))
        for pack, at, numbers in self._spans:
            pack(data, at, *numbers(reading, self.options))
        return bytes(data)
