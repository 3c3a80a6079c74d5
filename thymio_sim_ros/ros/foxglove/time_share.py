"""Recurring work that may take only a share of a thread's time."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager

__all__ = ["TimeShare"]


class TimeShare:
    """After work of t seconds of processor time the next is due t / `share` seconds later."""

    def __init__(self, share: float) -> None:
        self._share = share
        self._next_s = float("-inf")

    @property
    def is_due(self) -> bool:
        """Whether the work may go on."""
        return time.monotonic() >= self._next_s

    @contextmanager
    def work(self) -> Iterator[None]:
        """What is done inside counts."""
        began_s = time.thread_time()
        try:
            yield
        finally:
            self._next_s = time.monotonic() + (time.thread_time() - began_s) / self._share
