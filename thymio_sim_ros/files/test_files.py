"""Files of a test's world that explain a failure: its run log and a picture of its robots' paths.

`pytest --run-logs DIR` writes them, named after the test.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from pathlib import Path

__all__ = ["kept_files", "run_log_path", "trace_path"]

_LONGEST = 100


def run_log_path(folder: Path, test: str) -> Path:
    """The run log of a test, given by its pytest node ID."""
    return folder / f"{_file_name(test)}.jsonl"


def trace_path(folder: Path, test: str) -> Path:
    """The picture of a test."""
    return folder / f"{_file_name(test)}.svg"


def kept_files(folder: Path, test: str) -> Mapping[str, Path]:
    """The files of a test by their short names, whether they exist or not."""
    return {"run.jsonl": run_log_path(folder, test), "trace.svg": trace_path(folder, test)}


def _file_name(test: str) -> str:
    """A file name that no other test has, also where its ID is long or has other characters."""
    readable = re.sub(r"[^\w.-]+", "_", test)[:_LONGEST].strip("_.")
    return f"{readable}-{hashlib.sha256(test.encode()).hexdigest()[:8]}"
