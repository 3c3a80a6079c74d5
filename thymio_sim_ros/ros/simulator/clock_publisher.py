"""Publishes simulated time on `/clock`, limited by wall time."""

from __future__ import annotations

import time

from rclpy.node import Node
from rosgraph_msgs.msg import Clock

from thymio_sim_ros.ros.interface.headers import SECOND_NS, stamp
from thymio_sim_ros.ros.rclpy_ext.subscription_count import counter
from thymio_sim_ros.ros.simulator.clock_conflict import ClockConflict
from thymio_sim_ros.ros.simulator.world_topics import TOPICS

__all__ = ["ClockPublisher"]

MIN_PERIOD_SHARE = 0.9
"""Part of the clock's period after which it may be published again, since ticks do not divide the period evenly."""

TOPIC = "/clock"


class ClockPublisher:
    """Publishes the clock, or nothing if it is switched off."""

    def __init__(self, node: Node, *, is_on: bool = True, rate_hz: float = 50.0) -> None:
        """`rate_hz`: largest rate in Hz of wall time."""
        self._gap_ns = round(MIN_PERIOD_SHARE * SECOND_NS / rate_hz)
        self._last_ns = 0
        self._has_subscribers = False
        self._publisher = node.create_publisher(TOPICS[TOPIC].type, TOPIC, TOPICS[TOPIC].profile) if is_on else None
        self._count = None if self._publisher is None else counter(self._publisher)
        self.conflict: ClockConflict | None = None
        """Detects other publishers of the clock; None if this one is switched off."""
        if self._publisher is not None:
            self.conflict = ClockConflict(node, self._publisher.topic_name, node.context.get_domain_id())

    @property
    def due_ns(self) -> int | None:
        """The wall time in ns from which the clock may be published again; None without subscribers."""
        return self._last_ns + self._gap_ns if self._has_subscribers else None

    def poll(self) -> None:
        """Find out whether the clock has subscribers."""
        self._has_subscribers = self._count is not None and self._count() > 0

    def publish(self, now_ns: int, *, last: bool) -> None:
        """Publish simulated time, rate limited unless `last`: no other clock message is expected soon."""
        wall_ns = time.monotonic_ns()
        due_ns = self.due_ns
        if self._publisher is None or not (last or (due_ns is not None and wall_ns >= due_ns)):
            return
        self._last_ns = wall_ns
        self._publisher.publish(Clock(clock=stamp(now_ns)))
        if self.conflict is not None:
            self.conflict.record_published(now_ns)
