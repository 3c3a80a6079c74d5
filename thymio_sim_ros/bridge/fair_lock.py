"""A lock that waiting threads get before the thread that released it.

With a plain lock, a thread that releases and acquires it in a loop, such as a publisher without pauses, starves all
others, because a waiting thread has to wake up first. Here the next owner holds a second lock while it waits; a thread
that returns meanwhile has to wait for this second lock, and thus for the next owner.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from types import TracebackType

__all__ = ["FairLock"]


class FairLock:
    """A lock with `acquire` and `release`, or `with lock:`. Not reentrant."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._next_lock = threading.Lock()
        """Held by the thread that gets the lock next, while it waits; all other threads wait for this lock."""
        self._is_awaited = False
        self._acquire = self._lock.acquire
        self.release: Callable[[], None] = self._lock.release
        """Release the lock."""

    def acquire(self) -> None:
        """Acquire the lock; wait until no other thread holds it."""
        # The fast path takes a free lock without waiting, but only if no thread is waiting for it.
        if self._is_awaited or not self._acquire(False):
            with self._next_lock:
                self._is_awaited = True
                self._acquire()
                self._is_awaited = False

    def __enter__(self) -> None:
        self.acquire()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.release()
