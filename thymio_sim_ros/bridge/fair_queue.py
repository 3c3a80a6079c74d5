"""A queue that serves its senders in turn, so that one that fills it delays the others by one value each."""

from __future__ import annotations

from collections import OrderedDict, deque
from collections.abc import Callable, Hashable, Iterator
from typing import Generic, TypeVar

__all__ = ["FairQueue"]

K = TypeVar("K", bound=Hashable)
T = TypeVar("T")


class FairQueue(Generic[K, T]):
    """Values by sender: in order for each sender, round robin between senders. Not thread-safe."""

    def __init__(self) -> None:
        self._by_sender: OrderedDict[K, deque[T]] = OrderedDict()
        """No empty queues; the first sender is the next to be served."""
        self._count = 0

    def __len__(self) -> int:
        return self._count

    def __iter__(self) -> Iterator[T]:
        """All values, sender by sender."""
        return (value for queue in self._by_sender.values() for value in queue)

    def put(self, sender: K, value: T) -> None:
        """Append a value."""
        self._by_sender.setdefault(sender, deque()).append(value)
        self._count += 1

    def pop(self, is_free: Callable[[K], bool] = lambda sender: True) -> T:
        """Remove and return the next value of those senders; IndexError when there is none."""
        sender = next((sender for sender in self._by_sender if is_free(sender)), None)
        if sender is None:
            raise IndexError("no value to take")
        queue = self._by_sender[sender]
        value = queue.popleft()
        if queue:
            self._by_sender.move_to_end(sender)
        else:
            del self._by_sender[sender]
        self._count -= 1
        return value

    def remove(self, sender: K, value: T) -> bool:
        """Remove a value; whether it was there."""
        queue = self._by_sender.get(sender)
        if queue is None or value not in queue:
            return False
        queue.remove(value)
        if not queue:
            del self._by_sender[sender]
        self._count -= 1
        return True
