"""Ensures that rcl can create its log directory, without which it does not start.

rcl uses `ROS_LOG_DIR`, else `log` in `ROS_HOME`, else `.ros/log` in `HOME`, on Windows in `USERPROFILE`. Containers and
services may have none of these, or one that is not writable.
"""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import MutableMapping
from pathlib import Path

__all__ = ["ensure"]

_NAME = "thymio-sim-log-"


def ensure(environment: MutableMapping[str, str] = os.environ) -> None:
    """Set `ROS_LOG_DIR` to a temporary folder, and report it on stderr, if rcl's default is not writable."""
    wanted = _wanted(environment)
    problem = "HOME is not set" if wanted is None else _problem(wanted)
    if not problem:
        return
    folder = tempfile.mkdtemp(prefix=_NAME)
    environment["ROS_LOG_DIR"] = folder
    print(f"thymio-sim: log files go to {folder}: {problem}; set ROS_LOG_DIR to choose another", file=sys.stderr)


def _wanted(environment: MutableMapping[str, str]) -> Path | None:
    if environment.get("ROS_LOG_DIR"):
        return Path(environment["ROS_LOG_DIR"]).expanduser()
    if environment.get("ROS_HOME"):
        return Path(environment["ROS_HOME"]).expanduser() / "log"
    home = environment.get("HOME") or environment.get("USERPROFILE")
    return Path(home) / ".ros" / "log" if home else None


def _problem(folder: Path) -> str:
    """Return the reason why log files cannot be written to `folder`, or an empty text."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        return f"{folder}: {error.strerror}"
    return "" if os.access(folder, os.W_OK | os.X_OK) else f"{folder}: cannot be written"
