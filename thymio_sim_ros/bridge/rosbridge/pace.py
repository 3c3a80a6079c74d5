"""When the messages of a subscription are sent: its throttle and its queue."""

from __future__ import annotations

from collections import deque
from math import inf
from typing import Generic, TypeVar

__all__ = ["MAX_QUEUE", "Pace"]

T = TypeVar("T")

MAX_QUEUE = 1000
"""Longest queue, messages."""


class Pace(Generic[T]):
    """At most one message in `period_s`. Those in between are queued, the oldest are dropped; without a queue, all are.

    The caller gives the time of a monotonic clock, s.
    """

    def __init__(self, period_s: float, queue_length: int) -> None:
        self._period_s = period_s
        self._queue: deque[T] = deque(maxlen=min(queue_length, MAX_QUEUE))
        self._next_s = -inf

    def offer(self, message: T, now_s: float) -> T | None:
        """Take a message; return the one that is due now, if any."""
        if not self._queue and now_s >= self._next_s:
            self._next_s = now_s + self._period_s
            return message
        due = self.due(now_s)
        self._queue.append(message)
        return due

    def due(self, now_s: float) -> T | None:
        """The queued message that is due now, if any."""
        if not self._queue or now_s < self._next_s:
            return None
        self._next_s = now_s + self._period_s
        return self._queue.popleft()

    @property
    def is_waiting(self) -> bool:
        """Whether messages are queued."""
        return bool(self._queue)
