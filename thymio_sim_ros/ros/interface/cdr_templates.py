"""Serialized messages that are made once and patched with each reading: a third of the cost of building them anew.

CDR keeps what does not change its size in place: the stamp of a header is at the beginning, numbers of fixed size are
so many bytes before the end. A row of `sensor_topics` says by a `Patch` which; a template is checked against the
serialiser when it is made.
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
"""Behind the encapsulation."""


@dataclass(frozen=True, slots=True)
class Span:
    """Numbers side by side, as `layout` packs them, with `behind` bytes of the message after them."""

    layout: struct.Struct
    numbers: Callable[[Any, Any], Sequence[float]]
    behind: int = 0


@dataclass(frozen=True, slots=True)
class Patch:
    """What a reading changes: some spans of the message, and its stamp if it has one."""

    spans: tuple[Span, ...]
    has_stamp: bool = True


class Template:
    """The bytes of one topic's messages, for one choice of options."""

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
        """The template of the message that this reading gave; None if patching it in does not give the same."""
        template = cls(patch, message, options)
        # Bytes between fields may be anything, hence messages are compared; by their text, where NaN equals NaN.
        try:
            filled = deserialize_message(template.fill(reading), type(message))
        except (RuntimeError, struct.error):  # a length was overwritten, or there is no room
            return None
        fresh = deserialize_message(serialize_message(message), type(message))
        return template if repr(filled) == repr(fresh) else None

    def at(self, stamp_ns: int) -> bytes:
        """The message with this stamp and nothing else changed."""
        _STAMP.pack_into(self._data, _STAMP_AT, *divmod(stamp_ns, SECOND_NS))
        return bytes(self._data)

    def fill(self, reading: Any) -> bytes:
        """The message of a reading."""
        data = self._data
        if self._has_stamp:
            _STAMP.pack_into(data, _STAMP_AT, *divmod(reading.stamp_ns, SECOND_NS))
        for pack, at, numbers in self._spans:
            pack(data, at, *numbers(reading, self.options))
        return bytes(data)
