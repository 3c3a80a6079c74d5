"""Values from any thread to the thread that spins a node's executor.

A guard condition would be the natural wake-up, but the events executor refuses them; `executor.create_task` is
thread-safe in every executor and wakes it. One task handles values for `SLICE_S`, then queues itself again behind
whatever the executor has to do meanwhile.
"""

from __future__ import annotations

import threading
import time
from collections import Counter
from collections.abc import Callable
from typing import Generic, TypeVar

from rclpy.node import Node

from thymio_sim_ros.ros.foxglove.fair_queue import FairQueue

T = TypeVar("T")

__all__ = ["SLICE_S", "Mailbox"]

SLICE_S = 0.005
"""Longest time for which values are handled before the executor's other work has its turn."""


class Mailbox(Generic[T]):
    """One-way street into a node's executor; `handle` is called there for each posted value.

    Values of one sender are handled in order, senders in turn.
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
        """`capacity`: sum of the weights of waiting values from which a sender should pause."""
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
        """Whether a task is on its way."""
        self._is_closed = False

    def is_full(self, sender: int = 0) -> bool:
        """Whether values of a weight of `capacity` wait: a polite sender pauses; `post` accepts more all the same."""
        return not self._is_closed and self._weights[sender] >= self._capacity

    def post(self, value: T) -> None:
        """Append a value; from any thread. Does nothing once the box is closed."""
        if self._is_closed:
            return
        sender = self._sender(value)
        with self._lock:
            self._queue.put(sender, value)
            self._weights[sender] += self._weight(value)
        self._schedule()

    def drain(self) -> None:
        """Handle what waits, for `slice_s` at most; executor's thread only. A timer may call it for values left before
        `add_node`.
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
        """Handle nothing any more."""
        self._is_closed = True

    def _schedule(self) -> None:
        executor = self._node.executor
        if executor is not None and not self._is_scheduled and not self._is_closed:
            self._is_scheduled = True
            executor.create_task(self.drain)
