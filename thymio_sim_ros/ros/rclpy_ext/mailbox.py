"""Passes values from any thread to the thread that spins a node's executor.

The events executor does not support guard conditions, so `executor.create_task` wakes the executor; it is thread-safe
in every executor. One task handles values for `SLICE_S`, then queues itself again behind the other work of the
executor.
"""

from __future__ import annotations

import threading
import time
from collections import Counter
from collections.abc import Callable
from typing import Generic, TypeVar

from rclpy.node import Node

from thymio_sim_ros.bridge.fair_queue import FairQueue

T = TypeVar("T")

__all__ = ["SLICE_S", "Mailbox"]

SLICE_S = 0.005
"""Longest time for which one task handles values."""


class Mailbox(Generic[T]):
    """Queue into a node's executor, which calls `handle` for each posted value.

    Values of one sender are handled in order; senders are served round robin.
    """

    def __init__(
        self,
        node: Node,
        handle: Callable[[T], None],
        *,
        sender: Callable[[T], int] = lambda value: 0,
        weight: Callable[[T], int] = lambda value: 1,
        capacity: int = 256,
        slice_s: float = SLICE_S,
    ) -> None:
        """`capacity`: total weight of a sender's waiting values at which `is_full` becomes true."""
        self._node = node
        self._handle = handle
        self._sender = sender
        self._weight = weight
        self._capacity = capacity
        self._slice_s = slice_s
        self._lock = threading.Lock()
        self._queue: FairQueue[int, T] = FairQueue()
        self._weights: Counter[int] = Counter()
        self._is_scheduled = False
        """Whether a task is queued in the executor."""
        self._is_closed = False

    def is_full(self, sender: int = 0) -> bool:
        """Whether a sender should pause. This is back-pressure by agreement: `post` still accepts values."""
        return not self._is_closed and self._weights[sender] >= self._capacity

    def post(self, value: T) -> None:
        """Append a value. Thread-safe. Does nothing once the mailbox is closed."""
        if self._is_closed:
            return
        sender = self._sender(value)
        with self._lock:
            self._queue.put(sender, value)
            self._weights[sender] += self._weight(value)
        self._schedule()

    def drain(self) -> None:
        """Handle waiting values for at most `slice_s`; only on the executor's thread.

        Values posted before `add_node` wake no executor; a timer may call this for them.
        """
        self._is_scheduled = False
        end_s = time.monotonic() + self._slice_s
        while not self._is_closed:
            with self._lock:
                if not self._queue:
                    return
                value = self._queue.pop()
                sender = self._sender(value)
                self._weights[sender] -= self._weight(value)
                if not self._weights[sender]:
                    del self._weights[sender]
            self._handle(value)
            if time.monotonic() >= end_s:
                self._schedule()
                return

    def close(self) -> None:
        """Stop handling values; waiting ones are dropped."""
        self._is_closed = True

    def _schedule(self) -> None:
        executor = self._node.executor
        if executor is not None and not self._is_scheduled and not self._is_closed:
            self._is_scheduled = True
            executor.create_task(self.drain)
