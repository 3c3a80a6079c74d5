"""The filters of log calls: `throttle_duration_sec`, `skip_first` and `once`, in the order in which they are asked."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from thymio_sim_ros.portable_ros.rclpy.clock import Clock
from thymio_sim_ros.portable_ros.rclpy.constants import S_TO_NS

__all__ = ["LogFilter", "check_options", "filters_of"]

_OPTIONS = ("throttle_duration_sec", "throttle_time_source_type", "skip_first", "once")


class LogFilter(Protocol):
    """Passes or drops the lines of one call."""

    def passes(self) -> bool:
        """Whether the next line of the call is logged."""


class _Throttle:
    """Drops lines until a duration has passed since the last one."""

    def __init__(self, seconds: float, clock: Clock) -> None:
        self._period_ns, self._clock = seconds * S_TO_NS, clock
        self._last_ns = 0

    def passes(self) -> bool:
        """Whether the period is over, which it is not before one period of simulated time."""
        now_ns = self._clock.now().nanoseconds
        if now_ns < self._last_ns + self._period_ns:
            return False
        self._last_ns = now_ns
        return True


class _SkipFirst:
    """Drops the first line."""

    def __init__(self) -> None:
        self._is_skipped = False

    def passes(self) -> bool:
        """Whether a line was dropped before."""
        was_skipped, self._is_skipped = self._is_skipped, True
        return was_skipped


class _Once:
    """Drops all lines but the first."""

    def __init__(self) -> None:
        self._is_logged = False

    def passes(self) -> bool:
        """Whether no line was passed before."""
        was_logged, self._is_logged = self._is_logged, True
        return not was_logged


def check_options(options: Mapping[str, Any]) -> None:
    """Raise TypeError for options that do not exist, or of which one is missing."""
    if options.get("throttle_time_source_type") and "throttle_duration_sec" not in options:
        raise TypeError(
            'required parameter "throttle_duration_sec" not specified but is required for the the logging filter'
            ' "throttle"'
        )
    for name in options:
        if name not in _OPTIONS:
            raise TypeError(f'parameter "{name}" is not one of the recognized logging options "{list(_OPTIONS)}"')


def filters_of(options: Mapping[str, Any]) -> tuple[LogFilter, ...]:
    """The filters that options ask for. Raises ValueError for a source of time that is no clock."""
    found: list[LogFilter] = []
    if seconds := options.get("throttle_duration_sec"):
        clock = options.get("throttle_time_source_type") or Clock()
        if not isinstance(clock, Clock):
            raise ValueError(f'Received throttle_time_source_type of "{clock}" is not a clock instance')
        found.append(_Throttle(seconds, clock))
    if options.get("skip_first"):
        found.append(_SkipFirst())
    if options.get("once"):
        found.append(_Once())
    return tuple(found)
