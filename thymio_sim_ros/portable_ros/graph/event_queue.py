"""A queue of events of one entity, limited as its quality of service says."""

from __future__ import annotations

import threading
from collections import deque
from typing import Generic, TypeVar

__all__ = ["EventQueue"]

T = TypeVar("T")


class EventQueue(Generic[T]):
    """Events in the order of their arrival; a full queue drops the oldest. Thread-safe."""

    def __init__(self, limit: int | None) -> None:
        """`limit`: the largest number of events, None for any number."""
        self._events: deque[T] = deque(maxlen=limit)
        self._lock = threading.Lock()

    def put(self, event: T) -> bool:
        """Append an event; return whether there is one more now."""
        with self._lock:
            before = len(self._events)
            self._events.append(event)
            return len(self._events) > before

    def get(self) -> T | None:
        """Remove the oldest event; None if there is none."""
        with self._lock:
            return self._events.popleft() if self._events else None

    def __len__(self) -> int:
        return len(self._events)
