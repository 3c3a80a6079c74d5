"""Commands from the Aseba runtime of the same process, which arrive without DDS.

Used where the endpoints of a process do not match each other (`compat/dds_profile.py`). The messages are those of the
command topics, and have the same effect.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from typing import Any

from rclpy.node import Node

__all__ = ["DEPTH", "LocalCommands"]

DEPTH = 10
"""Waiting messages of one topic; a further one replaces the oldest, as in a subscription with "keep last"."""


class LocalCommands:
    """Queue from any thread to the thread that spins the node's executor; messages of all topics stay in order."""

    def __init__(self, node: Node, receive: Callable[[str, str, Any], None]) -> None:
        """`receive` gets the ROS name of the robot, the topic without that name, and the message."""
        self._node, self._receive = node, receive
        self._lock = threading.Lock()
        self._order: deque[tuple[str, str]] = deque()
        """Robot and topic of each waiting message."""
        self._waiting: dict[tuple[str, str], deque[Any]] = {}
        self._is_scheduled = False

    def post(self, robot: str, topic: str, message: Any) -> None:
        """Append a message, which must not change afterwards. Thread-safe."""
        key = robot, topic
        with self._lock:
            messages = self._waiting.setdefault(key, deque())
            if len(messages) >= DEPTH:
                messages.popleft()
            else:
                self._order.append(key)
            messages.append(message)
            executor = self._node.executor
            if executor is None or self._is_scheduled:
                return
            self._is_scheduled = True
        executor.create_task(self.deliver)

    def deliver(self) -> None:
        """Handle the messages that are waiting now; only on the executor's thread."""
        with self._lock:
            self._is_scheduled = False
            ready = [(*key, self._waiting[key].popleft()) for key in self._order]
            self._order.clear()
        for robot, topic, message in ready:
            self._receive(robot, topic, message)
