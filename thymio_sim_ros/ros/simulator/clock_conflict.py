"""Detects another simulator on the same clock topic: time would jump between the two and restart programs.

A second publisher in the graph is no proof, because discovery keeps a killed one for some 20 s. So while there is one,
the simulator subscribes to the clock; messages that it did not publish itself are the proof.
"""

from __future__ import annotations

import time
from collections import Counter, deque
from collections.abc import Callable

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from rclpy.node import Node
from rclpy.subscription import Subscription
from rosgraph_msgs.msg import Clock

from thymio_sim_ros.ros.interface import qos
from thymio_sim_ros.ros.interface.headers import SECOND_NS

__all__ = ["ClockConflict"]

PROOF = 2
"""Number of foreign messages within `REMEMBERED_S` that prove another simulator."""
REMEMBERED_S = 5.0
"""Wall time; a paused simulator publishes once a second."""
_OWN = 512
"""Number of its own stamps that are remembered: those of ten seconds."""


class ClockConflict:
    """Detects other publishers of a simulator's clock and warns once. Costs nothing while there is no other one."""

    def __init__(self, node: Node, topic: str, domain: int, now_s: Callable[[], float] = time.monotonic) -> None:
        """`topic`: the resolved name of the clock; `domain`: ROS_DOMAIN_ID, for the warning."""
        self._node = node
        self._topic = topic
        self._domain = domain
        self._now_s = now_s
        self._subscription: Subscription | None = None
        self._own: Counter[int] = Counter()
        self._order: deque[int] = deque()
        self._foreign_s: deque[float] = deque(maxlen=PROOF)
        self.is_found = False
        """Whether another simulator publishes the clock."""

    def record_published(self, now_ns: int) -> None:
        """Record a stamp that this simulator publishes."""
        self._order.append(now_ns)
        self._own[now_ns] += 1
        if len(self._order) > _OWN:
            self._forget(self._order.popleft())

    def poll(self) -> None:
        """Check the graph and the messages since the last poll, and warn about a new conflict."""
        if self._node.count_publishers(self._topic) > 1:
            if self._subscription is None:
                self._subscription = self._node.create_subscription(Clock, self._topic, self._on_clock, qos.CLOCK)
        elif self._subscription is not None:
            self._node.destroy_subscription(self._subscription)
            self._subscription = None
            self._foreign_s.clear()
        was_found, self.is_found = self.is_found, self._is_proven()
        if self.is_found and not was_found:
            self._node.get_logger().warning(self._text())

    def status(self) -> DiagnosticStatus:
        """Return the entry for `/diagnostics`: ERROR while there is another simulator."""
        return DiagnosticStatus(
            level=DiagnosticStatus.ERROR if self.is_found else DiagnosticStatus.OK,
            name=f"{self._node.get_fully_qualified_name().removeprefix('/')}: clock",
            hardware_id="thymio_sim_ros",
            message=self._text() if self.is_found else "the only publisher",
            values=[KeyValue(key="topic", value=self._topic), KeyValue(key="domain", value=str(self._domain))],
        )

    def _is_proven(self) -> bool:
        return len(self._foreign_s) == PROOF and self._now_s() - self._foreign_s[0] < REMEMBERED_S

    def _on_clock(self, message: Clock) -> None:
        now_ns = message.clock.sec * SECOND_NS + message.clock.nanosec
        if self._own[now_ns] > 0:
            self._forget(now_ns)
        else:
            self._foreign_s.append(self._now_s())

    def _forget(self, now_ns: int) -> None:
        self._own[now_ns] -= 1
        if self._own[now_ns] <= 0:
            del self._own[now_ns]

    def _text(self) -> str:
        return (
            f"{self._topic}: another simulator publishes it in ROS_DOMAIN_ID {self._domain}, so time jumps and "
            "programs restart. Stop one of them, or give it its own ROS_DOMAIN_ID; for simulators with "
            "namespaces in one domain remap each clock, for example with -r /clock:=/lab1/clock"
        )
