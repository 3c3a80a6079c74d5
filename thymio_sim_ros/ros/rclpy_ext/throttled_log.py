"""Log warnings throttled by subject, so that an error at 10 Hz is logged every five seconds only."""

from __future__ import annotations

import math
import time

from rclpy.node import Node

from thymio_sim_ros.ros.rclpy_ext.local_node import LocalNode

__all__ = ["WARN_EVERY_S", "ThrottledLog"]

WARN_EVERY_S = 5.0
"""Shortest time between two warnings about one subject."""
_MAX_KEYS = 1000
"""Subjects that are remembered; limited, because their names may come from untrusted clients."""


class ThrottledLog:
    """Logs warnings of a node, at most one per subject (a topic, an event) in `WARN_EVERY_S`.

    rclpy throttles by source location, so one topic's warning would suppress those of all others.
    """

    def __init__(self, node: Node | LocalNode) -> None:
        self._node = node
        self._told_s: dict[str, float] = {}

    def __call__(self, about: str, text: str) -> None:
        """Log the warning `about text`."""
        now_s = time.monotonic()
        if now_s - self._told_s.get(about, -math.inf) < WARN_EVERY_S:
            return
        if len(self._told_s) >= _MAX_KEYS:
            self._told_s.clear()
        self._told_s[about] = now_s
        self._node.get_logger().warning(f"{about} {text}")
