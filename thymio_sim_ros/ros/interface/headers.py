"""Stamps and frames of messages."""

from __future__ import annotations

from typing import Protocol, TypeVar

from builtin_interfaces.msg import Time
from std_msgs.msg import Header

SECOND_NS = 1_000_000_000


class _WithHeader(Protocol):
    @property
    def header(self) -> Header: ...


M = TypeVar("M", bound=_WithHeader)


def stamp(ns: int) -> Time:
    """Return simulated time in ns as a message."""
    return Time(sec=ns // SECOND_NS, nanosec=ns % SECOND_NS)


def stamped(message: M, ns: int, frame: str) -> M:
    """Fill in the header of a message and return the message."""
    message.header.stamp = stamp(ns)
    message.header.frame_id = frame
    return message
