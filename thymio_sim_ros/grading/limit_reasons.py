"""Reasons for limits, in words for pupils; recognizes limits that a program meets as an error, such as a full disk."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import asdict

from thymio_sim_ros.grading.assignment import MAX_FILES, Limits

__all__ = ["limit_in", "reason"]

_REASONS: Mapping[str, str] = {
    "CPU time limit": "the program computed for more than {cpu_s:g} s: look for a loop that never ends",
    "idle limit": "the program did nothing for {idle_s:g} s: look for a sleep, or a wait that never ends",
    "wall-clock limit": "the program took more than {wall_s:g} s for all tests: look for long waits",
    "output limit": "the program printed more than {output_mb:g} MB: look for a print() in a loop that never ends",
    "disk limit": "the program wrote more than {disk_mb:g} MB or {files} files: look for a loop that never ends",
    "memory limit": "the program needed more than {memory_mb:g} MB of memory: look for a list that keeps growing",
    "process limit": "the program started more than {processes} processes and threads: look for a loop that never ends",
    "file limit": "the program has too many open files: close each one after use",
}
"""Meaning of each outcome, and advice."""

_SIGNS: Mapping[str, str] = {
    "output limit": r"printed more than [\d.]+ MB",
    "disk limit": r"\[Errno (?:27|28|122)\]|the disk is full|No usable temporary directory",
    "memory limit": r"MemoryError\b|\[Errno 12\]|bad_alloc|(?i:cannot allocate memory)|Unable to allocate \S+ \wiB",
    "process limit": r"can't start new thread|\[Errno 11\]",
    "file limit": r"\[Errno 24\]",
}
"""Outcomes: what the message of a test has."""


def reason(outcome: str, limits: Limits) -> str:
    """Return what a limit means, given by its outcome, and what to do."""
    return _REASONS[outcome].format(**asdict(limits), files=MAX_FILES)


def limit_in(message: str, limits: Limits) -> tuple[str, str] | None:
    """Return the outcome and the reason, if a message of a test that failed has an error by which a limit shows."""
    for outcome, sign in _SIGNS.items():
        if re.search(sign, message):
            return outcome, reason(outcome, limits)
    return None
