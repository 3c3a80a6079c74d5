"""Durations in nanoseconds."""

from __future__ import annotations

import functools

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.rclpy.constants import S_TO_NS

__all__ = ["Duration", "Infinite"]

_LIMIT_NS = 2**63


@functools.total_ordering
class Duration:
    """A duration; seconds are truncated to nanoseconds."""

    def __init__(self, *, seconds: float = 0, nanoseconds: float = 0) -> None:
        total_ns = int(seconds * S_TO_NS) + int(nanoseconds)
        if not -_LIMIT_NS <= total_ns < _LIMIT_NS:
            raise OverflowError("Total nanoseconds value is too large to store in C duration.")
        self._nanoseconds = total_ns

    @property
    def nanoseconds(self) -> int:
        """The whole duration."""
        return self._nanoseconds

    def __repr__(self) -> str:
        return f"Duration(nanoseconds={self._nanoseconds})"

    def __str__(self) -> str:
        return "Infinite" if self == Infinite else f"{self._nanoseconds} nanoseconds"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Duration) and self._nanoseconds == other._nanoseconds

    def __lt__(self, other: object) -> bool:
        if not isinstance(other, Duration):
            return NotImplemented
        return self._nanoseconds < other._nanoseconds

    def __hash__(self) -> int:
        return hash(self._nanoseconds)

    def to_msg(self) -> ros_types.DurationMessage:
        """The message of the duration."""
        seconds, nanoseconds = divmod(self._nanoseconds, S_TO_NS)
        return ros_types.DurationMessage(sec=seconds, nanosec=nanoseconds)

    @classmethod
    def from_msg(cls, msg: ros_types.DurationMessage) -> Duration:
        """The duration of a message. Raises TypeError for a message of another type."""
        if not isinstance(msg, ros_types.DurationMessage):
            raise TypeError("Must pass a builtin_interfaces.msg.Duration object")
        return cls(nanoseconds=msg.sec * S_TO_NS + msg.nanosec)


Infinite = Duration(nanoseconds=_LIMIT_NS - 1)
