"""Loggers: lines of programs on standard error and on `/rosout`."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from thymio_sim_ros.portable_ros.graph import log_levels
from thymio_sim_ros.portable_ros.graph.time_base import system_ns
from thymio_sim_ros.portable_ros.rclpy.impl.logging_severity import LoggingSeverity
from thymio_sim_ros.portable_ros.rclpy_parts.log_filters import LogFilter, check_options, filters_of

__all__ = ["RcutilsLogger"]

Sink = Callable[[str, int, str, int, tuple[str, str, int]], None]
"""Gets name, level, text, time in nanoseconds and place of a line."""

CallPlace = tuple[tuple[str, str, int], int]
"""File, function and line of a call, and its index in the bytecode: a line may have several."""

_sinks: dict[str, Sink] = {}


@dataclass(frozen=True, slots=True)
class _Call:
    """A line of a program that logs: what its first call asked for."""

    level: LoggingSeverity
    name: str
    options: dict[str, Any]
    filters: tuple[LogFilter, ...]


def add_sink(name: str, sink: Sink) -> None:
    """Pass the lines of a log, and of those below it, to a function."""
    _sinks[name] = sink


def remove_sink(name: str) -> None:
    """Undo `add_sink`."""
    _sinks.pop(name, None)


class RcutilsLogger:
    """The log of a name; its filters (`once`, `skip_first`, `throttle_duration_sec`) belong to the line of a call."""

    def __init__(self, name: str = "") -> None:
        self.name = name
        self._calls: dict[CallPlace, _Call] = {}

    def get_child(self, name: str) -> RcutilsLogger:
        """The log below this one. Raises ValueError for an empty name."""
        if not name:
            raise ValueError("Child logger name must not be empty.")
        return RcutilsLogger(f"{self.name}.{name}" if self.name else name)

    def set_level(self, level: int) -> None:
        """Log only lines of this level and above."""
        log_levels.set_level(self.name, int(LoggingSeverity(level)))

    def get_effective_level(self) -> LoggingSeverity:
        """The level of this log, or that of the nearest one above it."""
        return LoggingSeverity(log_levels.effective_level(self.name))

    def is_enabled_for(self, severity: int) -> bool:
        """Whether lines of a level are logged."""
        return log_levels.effective_level(self.name) <= LoggingSeverity(severity)

    def log(self, message: str, severity: int, **kwargs: Any) -> bool:
        """Log a line; return whether it was logged.

        Raises TypeError for a line that is no text, and TypeError and ValueError for wrong or changed options.
        """
        level = LoggingSeverity(severity)
        if not self.is_enabled_for(level):
            return False
        frame = inspect.currentframe()
        while frame is not None and frame.f_code.co_filename == __file__:
            frame = frame.f_back
        if frame is None:
            return False
        place = frame.f_code.co_filename, frame.f_code.co_name, frame.f_lineno
        name = kwargs.pop("name", self.name)
        if not self._has_passed((place, frame.f_lasti), level, name, kwargs):
            return False
        if not isinstance(message, str):
            raise TypeError(f"message of a log: found {message!r}, expected a str")
        now_ns = system_ns()
        log_levels.print_line(name, level, message, now_ns, place)
        sink = next((_sinks[one] for one in _above(name) if one in _sinks), None)
        if sink is not None:
            sink(name, level, message, now_ns, place)
        return True

    def debug(self, message: str, **kwargs: Any) -> bool:
        """Log a line of the level DEBUG."""
        return self.log(message, LoggingSeverity.DEBUG, **kwargs)

    def info(self, message: str, **kwargs: Any) -> bool:
        """Log a line of the level INFO."""
        return self.log(message, LoggingSeverity.INFO, **kwargs)

    def warning(self, message: str, **kwargs: Any) -> bool:
        """Log a line of the level WARN."""
        return self.log(message, LoggingSeverity.WARN, **kwargs)

    def warn(self, message: str, **kwargs: Any) -> bool:
        """Log a line of the level WARN."""
        return self.log(message, LoggingSeverity.WARN, **kwargs)

    def error(self, message: str, **kwargs: Any) -> bool:
        """Log a line of the level ERROR."""
        return self.log(message, LoggingSeverity.ERROR, **kwargs)

    def fatal(self, message: str, **kwargs: Any) -> bool:
        """Log a line of the level FATAL."""
        return self.log(message, LoggingSeverity.FATAL, **kwargs)

    def _has_passed(self, call: CallPlace, level: LoggingSeverity, name: str, options: dict[str, Any]) -> bool:
        """Whether the filters of a call let its line pass.

        Raises TypeError for wrong options, and ValueError if a call changes its level, name or options.
        """
        check_options(options)
        known = self._calls.get(call)
        if known is None:
            known = self._calls[call] = _Call(level, name, options, filters_of(options))
        if level != known.level:
            raise ValueError("Logger severity cannot be changed between calls.")
        if name != known.name:
            raise ValueError("Logger name cannot be changed between calls.")
        if _wanted(options) != _wanted(known.options):
            raise ValueError("Requested logging filters cannot be changed between calls.")
        if options != known.options:
            raise ValueError("Logging filter parameters cannot be changed between calls.")
        return all(one.passes() for one in known.filters)


def _wanted(options: dict[str, Any]) -> set[str]:
    """The options that ask for a filter."""
    return {name for name, value in options.items() if value}


def _above(name: str) -> list[str]:
    """A name of a log, and those above it."""
    parts = name.split(".")
    return [".".join(parts[:count]) for count in range(len(parts), 0, -1)]
