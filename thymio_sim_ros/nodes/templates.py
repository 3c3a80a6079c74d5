"""Serialised messages that are made once and patched with each reading: a third of the cost of building them anew.

CDR keeps what does not change its size in place: the stamp of a header is at the beginning, numbers of fixed size are
at the end. A row of `convert` says by a `Patch` which; a template is checked against the serialiser when it is made.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from rclpy.serialization import deserialize_message, serialize_message

from thymio_sim_ros.nodes.headers import SECOND_NS

__all__ = ["Patch", "Template"]

_STAMP = struct.Struct("<iI")
_STAMP_AT = 4
"""Behind the encapsulation."""


@dataclass(frozen=True, slots=True)
class Patch:
    """What a reading changes: the last numbers of the message, as `tail` packs them, and its stamp if it has one."""

    tail: struct.Struct
    numbers: Callable[[Any, Any], Sequence[float]]
    has_stamp: bool = True


class Template:
    """The bytes of one topic's messages, for one choice of options."""

    __slots__ = ("_at", "_data", "_patch", "options")

    def __init__(self, patch: Patch, message: Any, options: Any) -> None:
        self.options = options
        self._patch = patch
        self._data = bytearray(serialize_message(message))
        self._at = len(self._data) - patch.tail.size

    @classmethod
    def checked(cls, patch: Patch, message: Any, reading: Any, options: Any) -> Template | None:
        """The template of the message that this reading gave; None if patching it in does not give the same."""
        template = cls(patch, message, options)
        # Bytes between fields may be anything, hence messages are compared.
        filled, fresh = (
            deserialize_message(data, type(message)) for data in (template.fill(reading), serialize_message(message))
        )
        return template if filled == fresh else None

    def fill(self, reading: Any) -> bytes:
        """The message of a reading."""
        data, patch = self._data, self._patch
        if patch.has_stamp:
            _STAMP.pack_into(data, _STAMP_AT, *divmod(reading.stamp_ns, SECOND_NS))
        patch.tail.pack_into(data, self._at, *patch.numbers(reading, self.options))
        return bytes(data)
