"""The processes of a submission: how they start, what they use, and how they end. Each system has its own way."""

from __future__ import annotations

import subprocess
from dataclasses import dataclass
from typing import Any, Protocol

__all__ = ["Processes", "Usage"]


@dataclass(frozen=True, slots=True)
class Usage:
    """Processor time in s of all processes, also of those that have ended; whether any is known to work now."""

    cpu_s: float
    is_working: bool


class Processes(Protocol):
    """The processes of a submission: a test process and all its descendants."""

    def options(self) -> dict[str, Any]:
        """Options of Popen for the test process, with which it begins confined."""

    def started(self, process: subprocess.Popen[bytes]) -> None:
        """Follow a new test process."""

    def used(self) -> Usage:
        """Return what the processes use."""

    def memory_used(self, limit: int) -> int:
        """Memory in bytes; exact only if it is not far below `limit`."""

    def end(self, process: subprocess.Popen[bytes]) -> None:
        """End all processes, and reap the test process."""
