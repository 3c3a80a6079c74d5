"""Points in time, each of a clock."""

from __future__ import annotations

from typing import overload

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.rclpy.clock_type import ClockType
from thymio_sim_ros.portable_ros.rclpy.constants import S_TO_NS
from thymio_sim_ros.portable_ros.rclpy.duration import Duration

__all__ = ["Time"]

_LIMIT_NS = 2**63


class Time:
    """A point in time; seconds are truncated to nanoseconds.

    Raises ValueError for negative arguments and OverflowError for times that 64 bits cannot hold.
    """

    def __init__(
        self, *, seconds: float = 0, nanoseconds: float = 0, clock_type: ClockType = ClockType.SYSTEM_TIME
    ) -> None:
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        if seconds < 0:
            raise ValueError("Seconds value must not be negative")
        if nanoseconds < 0:
            raise ValueError("Nanoseconds value must not be negative")
        total_ns = int(seconds * S_TO_NS) + int(nanoseconds)
        if total_ns >= _LIMIT_NS:
            raise OverflowError("Total nanoseconds value is too large to store in C time point.")
        self._nanoseconds, self._clock_type = total_ns, clock_type

    @property
    def nanoseconds(self) -> int:
        """Nanoseconds since the epoch of the clock."""
        return self._nanoseconds

    @property
    def clock_type(self) -> ClockType:
        """The kind of the clock."""
        return self._clock_type

    def seconds_nanoseconds(self) -> tuple[int, int]:
        """Whole seconds and the remaining nanoseconds."""
        return divmod(self._nanoseconds, S_TO_NS)

    def __repr__(self) -> str:
        return f"Time(nanoseconds={self._nanoseconds}, clock_type={self._clock_type.name})"

    def _moved(self, by_ns: int) -> Time:
        try:
            return Time(nanoseconds=self._nanoseconds + by_ns, clock_type=self._clock_type)
        except OverflowError as error:
            raise OverflowError("Addition leads to overflow in C storage.") from error
        except ValueError as error:
            raise ValueError("Subtraction leads to negative time.") from error

    def __add__(self, other: Duration) -> Time:
        if not isinstance(other, Duration):
            return NotImplemented
        return self._moved(other.nanoseconds)

    __radd__ = __add__

    @overload
    def __sub__(self, other: Time) -> Duration: ...

    @overload
    def __sub__(self, other: Duration) -> Time: ...

    def __sub__(self, other: Time | Duration) -> Time | Duration:
        if isinstance(other, Time):
            if self._clock_type != other._clock_type:
                raise TypeError("Can't subtract times with different clock types")
            return Duration(nanoseconds=self._nanoseconds - other._nanoseconds)
        if isinstance(other, Duration):
            return self._moved(-other.nanoseconds)
        return NotImplemented

    def _compared(self, other: object) -> int | None:
        """The nanoseconds of another time of the same clock; None for other objects."""
        if not isinstance(other, Time):
            return None
        if self._clock_type != other._clock_type:
            raise TypeError("Can't compare times with different clock types")
        return other._nanoseconds

    def __eq__(self, other: object) -> bool:
        return self._nanoseconds == self._compared(other)

    def __lt__(self, other: object) -> bool:
        at = self._compared(other)
        return NotImplemented if at is None else self._nanoseconds < at

    def __le__(self, other: object) -> bool:
        at = self._compared(other)
        return NotImplemented if at is None else self._nanoseconds <= at

    def __gt__(self, other: object) -> bool:
        at = self._compared(other)
        return NotImplemented if at is None else self._nanoseconds > at

    def __ge__(self, other: object) -> bool:
        at = self._compared(other)
        return NotImplemented if at is None else self._nanoseconds >= at

    __hash__ = None  # type: ignore[assignment]  # as rclpy's

    def to_msg(self) -> ros_types.TimeMessage:
        """The message of the time."""
        seconds, nanoseconds = self.seconds_nanoseconds()
        return ros_types.TimeMessage(sec=seconds, nanosec=nanoseconds)

    @classmethod
    def from_msg(cls, msg: ros_types.TimeMessage, clock_type: ClockType = ClockType.ROS_TIME) -> Time:
        """The time of a message. Raises TypeError for a message of another type."""
        if not isinstance(msg, ros_types.TimeMessage):
            raise TypeError("Must pass a builtin_interfaces.msg.Time object")
        return cls(seconds=msg.sec, nanoseconds=msg.nanosec, clock_type=clock_type)
