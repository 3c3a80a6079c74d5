"""Whose turn it is: one thread waits for it, others take it only if it is free.

A plain lock would starve the one that waits: a thread that gives it back and takes it again at once, as one that sends
without a pause does, is always quicker than one that has to wake up first.
"""

from __future__ import annotations

import threading
from types import TracebackType

__all__ = ["Turn"]


class Turn:
    """`with turn:` waits, in one thread only; `take` and `give_back` are for the others."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._is_awaited = False

    def __enter__(self) -> None:
        self._is_awaited = True
        self._lock.acquire()
        self._is_awaited = False

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._lock.release()

    def take(self) -> bool:
        """Take the turn if nobody has it or waits for it; returns whether it is ours."""
        return not self._is_awaited and self._lock.acquire(blocking=False)

    def give_back(self) -> None:
        """End a turn that was taken."""
        self._lock.release()
