"""The levels of logs by their names, and how lines are printed."""

from __future__ import annotations

import os
import sys
import threading
from contextlib import suppress

__all__ = ["LEVELS", "clear", "effective_level", "level_of", "number", "print_line", "set_level"]

LEVELS = {"UNSET": 0, "DEBUG": 10, "INFO": 20, "WARN": 30, "ERROR": 40, "FATAL": 50}
_NAMES = {level: name for name, level in LEVELS.items()}
_FORMAT = "[{severity}] [{time}] [{name}]: {message}"
_SECOND_NS = 1_000_000_000

is_printed = True
"""Whether lines are printed at all."""
_levels: dict[str, int] = {"": LEVELS["INFO"]}
_lock = threading.Lock()


def number(name: str) -> int:
    """The number of a level. Raises ValueError for an unknown name."""
    if name.upper() not in LEVELS:
        raise ValueError("Argument does not use a valid severity level")
    return LEVELS[name.upper()]


def set_level(name: str, level: int) -> None:
    """Set the level of a log; the empty name is that of the root."""
    _levels[name] = level


def clear() -> None:
    """Forget all levels that were set."""
    _levels.clear()
    _levels[""] = LEVELS["INFO"]


def level_of(name: str) -> int:
    """The level that was set for a log, 0 if none was."""
    return _levels.get(name, 0)


def effective_level(name: str) -> int:
    """The level of a log: its own or that of the nearest log above it."""
    while name:
        if level := _levels.get(name):
            return level
        name = name.rpartition(".")[0]
    return _levels[""]


def print_line(name: str, level: int, message: str, time_ns: int, place: tuple[str, str, int]) -> None:
    """Print a line to standard error; `place` is the file, function and line of the call."""
    if not is_printed:
        return
    seconds, nanoseconds = divmod(time_ns, _SECOND_NS)
    values = {
        "severity": _NAMES.get(level, str(level)),
        "time": f"{seconds}.{nanoseconds:09}",
        "time_as_nanoseconds": str(time_ns),
        "name": name,
        "message": message,
        "file_name": place[0],
        "function_name": place[1],
        "line_number": str(place[2]),
    }
    text = os.environ.get("RCUTILS_CONSOLE_OUTPUT_FORMAT", _FORMAT)
    for key, value in values.items():
        text = text.replace(f"{{{key}}}", value)
    stream = sys.stdout if os.environ.get("RCUTILS_LOGGING_USE_STDOUT") == "1" else sys.stderr
    with _lock, suppress(OSError, ValueError, AttributeError):  # closed
        stream.write(f"{text}\n")
        stream.flush()
