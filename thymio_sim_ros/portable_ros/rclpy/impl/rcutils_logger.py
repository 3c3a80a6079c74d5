"""Loggers: lines of programs on standard error and on `/rosout`."""

from __future__ import annotations

import inspect
import time
from collections.abc import Callable
from typing import Any

from thymio_sim_ros.portable_ros.graph import log_levels
from thymio_sim_ros.portable_ros.rclpy.clock import Clock
from thymio_sim_ros.portable_ros.rclpy.impl.logging_severity import LoggingSeverity
from thymio_sim_ros.portable_ros.rclpy.time import Time

__all__ = ["RcutilsLogger"]

Sink = Callable[[str, int, str, int, tuple[str, str, int]], None]
"""Gets name, level, text, time in nanoseconds and place of a line."""

_sinks: dict[str, Sink] = {}
_OPTIONS = frozenset({"throttle_duration_sec", "throttle_time_source_type", "skip_first", "once"})


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
        self._calls: dict[tuple[str, int], dict[str, Any]] = {}

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
        """Log a line; return whether it was logged."""
        frame = inspect.currentframe()
        while frame is not None and frame.f_code.co_filename == __file__:
            frame = frame.f_back
        if frame is None:
            return False
        place = frame.f_code.co_filename, frame.f_code.co_name, frame.f_lineno
        name = kwargs.pop("name", self.name)
        level = LoggingSeverity(severity)
        if not self._passes((place[0], frame.f_lasti), level, kwargs):
            return False
        if log_levels.effective_level(name) > level:
            return False
        now_ns = time.time_ns()
        log_levels.print_line(name, level, str(message), now_ns, place)
        sink = next((_sinks[one] for one in _above(name) if one in _sinks), None)
        if sink is not None:
            sink(name, level, str(message), now_ns, place)
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

    def _passes(self, call: tuple[str, int], level: LoggingSeverity, options: dict[str, Any]) -> bool:
        """Whether the filters of a call let its line pass. Raises TypeError or ValueError for wrong options."""
        if unknown := options.keys() - _OPTIONS:
            name = min(unknown)
            raise TypeError(f"parameter '{name}' is not one of the recognized logging options '{sorted(_OPTIONS)}'")
        known = self._calls.setdefault(call, {"level": level})
        if known["level"] != level:
            raise ValueError("Logger severity cannot be changed between calls.")
        if not options:
            return True
        count = known["count"] = known.get("count", 0) + 1
        if options.get("skip_first") and count == 1:
            return False
        if options.get("once"):
            was_logged, known["logged"] = known.get("logged", False), True
            return not was_logged
        seconds = options.get("throttle_duration_sec")
        return seconds is None or _is_due(known, seconds, options.get("throttle_time_source_type"))


def _is_due(known: dict[str, Any], seconds: float, clock: Clock | None) -> bool:
    """Whether so much time has passed since the last line of a call."""
    now = known.setdefault("clock", clock or Clock()).now()
    last: Time | None = known.get("last")
    if last is not None and now >= last and (now - last).nanoseconds < seconds * 1e9:
        return False
    known["last"] = now
    return True


def _above(name: str) -> list[str]:
    """A name of a log, and those above it."""
    parts = name.split(".")
    return [".".join(parts[:count]) for count in range(len(parts), 0, -1)]
