"""Warnings to a user, not too often: what goes wrong at 10 Hz is told every five seconds, whatever else goes wrong."""

from __future__ import annotations

import math
import time

from rclpy.node import Node

__all__ = ["WARN_EVERY_S", "ThrottledLog"]

WARN_EVERY_S = 5.0
"""Between two warnings about the same thing."""
_MAX_KEYS = 1000
"""So many things are remembered; their names may come from strangers."""


class ThrottledLog:
    """Warns in a node's log, about each thing (a topic, an event) at most once in `WARN_EVERY_S`.

    rclpy's own throttle goes by the place in the code, so that one topic's warning would hide those of all others.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._told_s: dict[str, float] = {}

    def __call__(self, about: str, text: str) -> None:
        """Say `about text`."""
        now_s = time.monotonic()
        if now_s - self._told_s.get(about, -math.inf) < WARN_EVERY_S:
            return
        if len(self._told_s) >= _MAX_KEYS:
            self._told_s.clear()
        self._told_s[about] = now_s
        self._node.get_logger().warning(f"{about} {text}")
