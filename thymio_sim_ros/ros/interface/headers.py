"""Stamps and frames of messages."""

from __future__ import annotations

from typing import Any

from builtin_interfaces.msg import Time

SECOND_NS = 1_000_000_000


def stamp(ns: int) -> Time:
    """Return simulated time in ns as a message."""
    return Time(sec=ns // SECOND_NS, nanosec=ns % SECOND_NS)


def stamped(message: Any, ns: int, frame: str) -> Any:
    """Fill in the header of a message and return the message."""
    message.header.stamp = stamp(ns)
    message.header.frame_id = frame
    return message
