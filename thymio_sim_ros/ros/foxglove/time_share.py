"""Limits recurring work to a share of a thread's time."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager

__all__ = ["TimeShare"]


class TimeShare:
    """Work that took t seconds of processor time is due again t / `share` seconds later."""

    def __init__(self, share: float) -> None:
        """`share` is in 0…1."""
        self._share = share
        self._next_s = float("-inf")

    @property
    def is_due(self) -> bool:
        """Whether the work may be done again."""
        return time.monotonic() >= self._next_s

    @contextmanager
    def work(self) -> Iterator[None]:
        """Measure the work inside the block."""
        began_s = time.thread_time()
        try:
            yield
        finally:
            self._next_s = time.monotonic() + (time.thread_time() - began_s) / self._share
