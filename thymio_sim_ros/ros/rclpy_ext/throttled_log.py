"""Log warnings throttled by subject and reason, so that an error at 10 Hz is logged every five seconds only."""

from __future__ import annotations

import math
import re
import time

from rclpy.node import Node

from thymio_sim_ros.ros.rclpy_ext.local_node import LocalNode

__all__ = ["WARN_EVERY_S", "ThrottledLog"]

WARN_EVERY_S = 5.0
"""Shortest time between two warnings about one subject for the same reason."""
_MAX_KEYS = 1000
"""Reasons that are remembered; limited, because their texts may come from untrusted clients."""
_NUMBER = re.compile(r"\d+(?:\.\d+)?(?:e[+-]?\d+)?")
"""Numbers, which may differ between two texts about the same reason."""


class ThrottledLog:
    """Logs warnings of a node, at most one per subject (a topic, an event) and reason in `WARN_EVERY_S`.

    Texts that differ in numbers only have the same reason.

    rclpy throttles by source location, so one topic's warning would suppress those of all others.
    """

    def __init__(self, node: Node | LocalNode) -> None:
        self._node = node
        self._logged_s: dict[tuple[str, str], float] = {}

    def __call__(self, about: str, text: str) -> None:
        """Log the warning `about text`."""
        now_s = time.monotonic()
        reason = about, _NUMBER.sub("0", text)
        if now_s - self._logged_s.get(reason, -math.inf) < WARN_EVERY_S:
            return
        if len(self._logged_s) >= _MAX_KEYS:
            self._logged_s.clear()
        self._logged_s[reason] = now_s
        self._node.get_logger().warning(f"{about} {text}")
