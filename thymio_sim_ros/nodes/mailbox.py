"""Values from any thread to the thread that turns a node's executor.

A guard condition would be the natural bell, but the events executor refuses them; `executor.create_task` is thread-safe
in every executor and wakes it. One task per batch.
"""

from __future__ import annotations

from collections.abc import Callable
from queue import Empty, SimpleQueue
from typing import Generic, TypeVar

from rclpy.node import Node

T = TypeVar("T")

__all__ = ["Mailbox"]


class Mailbox(Generic[T]):
    """One-way street into a node's executor; `handle` is called there, in order, for each posted value."""

    def __init__(self, node: Node, handle: Callable[[T], None], *, capacity: int = 1000) -> None:
        self._node = node
        self._handle = handle
        self._capacity = capacity
        self._queue: SimpleQueue[T] = SimpleQueue()
        self._bell_is_rung = False
        self._is_closed = False

    @property
    def is_full(self) -> bool:
        """Whether `capacity` values wait: a polite sender pauses; `post` takes more all the same."""
        return self._queue.qsize() >= self._capacity

    def post(self, value: T) -> None:
        """Leave a value; from any thread."""
        self._queue.put(value)
        executor = self._node.executor
        if executor is not None and not self._bell_is_rung and not self._is_closed:
            self._bell_is_rung = True
            executor.create_task(self.drain)

    def drain(self) -> None:
        """Handle all that waits; executor's thread only. A timer may call it for values left before `add_node`."""
        self._bell_is_rung = False
        while not self._is_closed:
            try:
                value = self._queue.get_nowait()
            except Empty:
                return
            self._handle(value)

    def close(self) -> None:
        """Handle nothing any more."""
        self._is_closed = True
