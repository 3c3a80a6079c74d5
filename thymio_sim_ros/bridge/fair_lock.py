"""Whose turn it is, among several threads.

A plain lock would starve those that wait: a thread that gives it back and takes it again at once, as one that sends
without a pause does, is always quicker than one that has to wake up first. Here who comes back finds the door closed as
long as somebody waits.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from types import TracebackType

__all__ = ["Turn"]


class Turn:
    """`take` it and `give_back`, or `with turn:`; not twice in one thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._door = threading.Lock()
        """Who waits for the lock has it; others wait for this one."""
        self._is_awaited = False
        self._acquire = self._lock.acquire
        self.give_back: Callable[[], None] = self._lock.release
        """End the turn."""

    def take(self) -> None:
        """Have the turn; others end theirs first."""
        if self._is_awaited or not self._acquire(False):
            with self._door:
                self._is_awaited = True
                self._acquire()
                self._is_awaited = False

    def __enter__(self) -> None:
        self.take()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.give_back()
