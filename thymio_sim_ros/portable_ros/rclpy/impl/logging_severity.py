"""Levels of logs."""

from __future__ import annotations

from enum import IntEnum

__all__ = ["LoggingSeverity"]


class LoggingSeverity(IntEnum):
    """The level of a log or of a line."""

    UNSET = 0
    DEBUG = 10
    INFO = 20
    WARN = 30
    ERROR = 40
    FATAL = 50
