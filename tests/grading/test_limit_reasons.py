"""Limits that a program meets as errors of its own are named in a pupil's words."""

from __future__ import annotations

import pytest

from thymio_sim_ros.grading.assignment import Limits
from thymio_sim_ros.grading.limit_reasons import limit_in


@pytest.mark.parametrize(
    ("message", "outcome", "reason"),
    [
        (
            "OSError: [Errno 28] No space left on device",
            "disk limit",
            "the program wrote more than 2.5 MB or 20000 files",
        ),
        (
            "E   FileNotFoundError: [Errno 2] No usable temporary directory found in [a]",
            "disk limit",
            "the program wrote more than",
        ),
        ("OSError: [Errno 27] File too large", "disk limit", "the program wrote more than"),
        ("Failed: p.py ended with exit code 1: the disk is full", "disk limit", "the program wrote more than"),
        ("p.py printed more than 10 MB", "output limit", "the program printed more than 10 MB"),
        ("MemoryError", "memory limit", "the program needed more than 1000 MB of memory"),
        (
            "numpy._core._exceptions._ArrayMemoryError: Unable to allocate 1.86 GiB for an array",
            "memory limit",
            "the program needed more than 1000 MB of memory",
        ),
        ("OSError: [Errno 12] Cannot allocate memory", "memory limit", "the program needed more than"),
        ("RuntimeError: can't start new thread", "process limit", "the program started more than 200 processes"),
        (
            "BlockingIOError: [Errno 11] Resource temporarily unavailable",
            "process limit",
            "the program started more than",
        ),
        ("OSError: [Errno 24] Too many open files", "file limit", "the program has too many open files"),
    ],
)
def test_errors_by_limits_are_named(message: str, outcome: str, reason: str) -> None:
    found = limit_in(f"p.py:3: in <module>\n    line\nE   {message}", Limits(disk_mb=2.5))
    assert found is not None
    assert found[0] == outcome
    assert found[1].startswith(reason)


def test_other_messages_are_no_limits() -> None:
    assert limit_in("assert reached(thymio, (28, 12))", Limits()) is None
