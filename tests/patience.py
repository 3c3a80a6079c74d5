"""How long tests wait for a condition: the only module of the tests that compares clocks.

A condition that holds ends its wait at once, so only a test that fails takes the whole time, and one generous time is
enough for all. A slower or busier machine needs more of it: the environment variable `THYMIO_TEST_PATIENCE` is a factor
of every wait (`THYMIO_TEST_PATIENCE=5 make test`).
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from typing import TypeVar

T = TypeVar("T")

PATIENCE_S = 60.0 * float(os.environ.get("THYMIO_TEST_PATIENCE", "1"))
"""Longest wait for an answer, a message, the start or the end of a process, in s of real time."""

PATIENCE_MS = 1000 * PATIENCE_S
"""The same for the browser, in ms."""

PROGRAM_S = 10 * PATIENCE_S
"""Longest run of a whole program that a test starts: a test run of its own, a benchmark, a page's command; in s."""


class Deadline:
    """The end of a wait that begins with the construction."""

    def __init__(self, patience_s: float = PATIENCE_S) -> None:
        self._end_s = time.monotonic() + patience_s

    @property
    def left_s(self) -> float:
        """Time that is left in s; 0 when the wait is over."""
        return max(0.0, self._end_s - time.monotonic())

    @property
    def is_over(self) -> bool:
        """Whether no time is left."""
        return self.left_s <= 0


def until(condition: Callable[[], T], describe: Callable[[], object] | None = None, *, every_s: float = 0.01) -> T:
    """Wait until a condition is true, and return its value.

    Args:
        condition: Evaluated again and again; anything that is true ends the wait.
        describe: What the failure reports, such as the output of a process.
        every_s: Pause between two evaluations in s.

    Raises:
        AssertionError: It is not true within `PATIENCE_S`.
    """
    deadline = Deadline()
    while not (value := condition()):
        if deadline.is_over:
            raise AssertionError(f"not within {PATIENCE_S:g} s" + (f": {describe()}" if describe else ""))
        time.sleep(every_s)
    return value
