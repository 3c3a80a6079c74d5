"""Logs by their names."""

from __future__ import annotations

import os
from pathlib import Path

from thymio_sim_ros.portable_ros.graph import log_levels
from thymio_sim_ros.portable_ros.rclpy.impl.logging_severity import LoggingSeverity
from thymio_sim_ros.portable_ros.rclpy.impl.rcutils_logger import RcutilsLogger

__all__ = [
    "LoggingSeverity",
    "clear_config",
    "get_logger",
    "get_logger_effective_level",
    "get_logger_level",
    "get_logging_directory",
    "get_logging_severity_from_string",
    "initialize",
    "set_logger_level",
    "shutdown",
]

_root_logger = RcutilsLogger()


def get_logger(name: str) -> RcutilsLogger:
    """The log of a name. Raises ValueError for an empty one."""
    if not name:
        raise ValueError("Logger name must not be empty.")
    return _root_logger.get_child(name)


def initialize() -> None:
    """Need nothing: logs work from the start."""


def shutdown() -> None:
    """Forget all levels that were set."""
    log_levels.clear()


def clear_config() -> None:
    """Forget all levels that were set."""
    shutdown()
    initialize()


def set_logger_level(name: str, level: int, detailed_error: bool = False) -> None:
    """Log only lines of this level and above."""
    log_levels.set_level(name, int(LoggingSeverity(level)))


def get_logger_level(name: str) -> LoggingSeverity:
    """The level that was set, UNSET if none was."""
    return LoggingSeverity(log_levels.level_of(name))


def get_logger_effective_level(name: str) -> LoggingSeverity:
    """The level of a log, or that of the nearest one above it."""
    return LoggingSeverity(log_levels.effective_level(name))


def get_logging_severity_from_string(log_severity: str) -> LoggingSeverity:
    """The level of a name. Raises RuntimeError for an unknown one."""
    try:
        return LoggingSeverity(log_levels.number(log_severity))
    except ValueError as error:
        raise RuntimeError(f"Failed to get log severity from {log_severity!r}: {error}") from error


def get_logging_directory() -> Path:
    """The folder of log files, which a program may use; the logs here have none."""
    home = Path(os.environ.get("ROS_HOME") or Path.home() / ".ros")
    return Path(os.environ.get("ROS_LOG_DIR") or home / "log")
