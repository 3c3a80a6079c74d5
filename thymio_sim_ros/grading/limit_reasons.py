"""Limits that a program meets as an error of its own, such as a full disk, recognized in messages of tests."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import asdict

from thymio_sim_ros.grading.assignment import Limits

__all__ = ["limit_in"]

_SIGNS: Mapping[str, tuple[str, str]] = {
    "output limit": (r"printed more than [\d.]+ MB", "it printed more than {output_mb:g} MB"),
    "disk limit": (
        r"\[Errno (?:27|28|122)\]|the disk is full|No usable temporary directory",
        "it wrote more than the {disk_mb:g} MB of files that it may write",
    ),
    "memory limit": (
        r"\bMemoryError\b|\[Errno 12\]|bad_alloc|Cannot allocate memory",
        "it needed more than the {memory_mb:g} MB of memory that it may use",
    ),
    "process limit": (
        r"can't start new thread|\[Errno 11\]",
        "it started more than the {processes} processes and threads that it may have at the same time",
    ),
    "file limit": (r"\[Errno 24\]", "it opened too many files at the same time"),
}
"""Outcomes: what the message of a test has, and what it means."""


def limit_in(message: str, limits: Limits) -> tuple[str, str] | None:
    """Return the outcome and the reason, if a message of a test that failed has an error by which a limit shows."""
    for outcome, (sign, reason) in _SIGNS.items():
        if re.search(sign, message):
            return outcome, reason.format(**asdict(limits))
    return None
