"""The short way past rclpy's publishers and subscriptions, for what is done hundreds of times a second.

Where an rclpy has no such way, the usual one is taken.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from typing import Any

from rclpy.serialization import deserialize_message
from std_msgs.msg import Int16MultiArray

__all__ = ["counter", "sender", "words_of"]

_LITTLE_ENDIAN_WITHOUT_LAYOUT = b"\0\1\0\0" + bytes(8)
"""Encapsulation of CDR, no dimensions, offset of the data 0."""
_COUNT_AT, _WORDS_AT = 12, 16


def sender(publisher: Any) -> Callable[[bytes], None]:
    """What sends serialised messages; `publish` first asks what it was given, which costs as much as to send it."""
    send: Callable[[bytes], None] = getattr(publisher.handle, "publish_raw", publisher.publish)
    return send


def counter(publisher: Any) -> Callable[[], int]:
    """What tells how many subscriptions a publisher has; not to be called once it is destroyed."""
    count: Callable[[], int] = getattr(publisher.handle, "get_subscription_count", publisher.get_subscription_count)
    return count


def words_of(message: bytes) -> Sequence[int]:
    """The numbers of a serialised Int16MultiArray; RuntimeError when it is none."""
    if message.startswith(_LITTLE_ENDIAN_WITHOUT_LAYOUT) and len(message) >= _WORDS_AT:
        (count,) = struct.unpack_from("<I", message, _COUNT_AT)
        if len(message) >= _WORDS_AT + 2 * count:
            return struct.unpack_from(f"<{count}h", message, _WORDS_AT)
    return deserialize_message(message, Int16MultiArray).data  # type: ignore[no-any-return]  # rclpy has no types
