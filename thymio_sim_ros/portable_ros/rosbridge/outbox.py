"""What waits to be sent, limited for each sender."""

from __future__ import annotations

import threading
from collections import deque
from typing import Any, Generic, TypeVar

__all__ = ["LIMIT", "Outbox"]

T = TypeVar("T")

LIMIT = 1000
"""The largest number of messages of a sender that wait, also where its profile has no limit."""


class Outbox(Generic[T]):
    """Queues of senders, which take turns: a sender with many messages delays those of others by one.

    A full queue drops the oldest message, as the history of a publisher does. Thread-safe.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._queues: dict[Any, deque[T]] = {}
        """Sender → its messages; the sender whose turn is next first. No queue is empty."""

    def put(self, sender: Any, item: T, limit: int | None) -> bool:
        """Append a message; at most `limit` of the sender wait. Return whether none was dropped."""
        most = LIMIT if limit is None else min(limit, LIMIT)
        with self._lock:
            queue = self._queues.setdefault(sender, deque())
            is_full = len(queue) >= most
            if is_full:
                queue.popleft()
            queue.append(item)
        return not is_full

    def take(self) -> tuple[Any, T] | None:
        """Remove the next message; return it with its sender, None if there is none."""
        with self._lock:
            if not self._queues:
                return None
            sender = next(iter(self._queues))
            queue = self._queues.pop(sender)
            item = queue.popleft()
            if queue:
                self._queues[sender] = queue
            return sender, item

    def clear(self) -> None:
        """Drop all messages."""
        with self._lock:
            self._queues.clear()
