"""A publisher for messages of clients, which loses none while subscribers discover it."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from rclpy._rclpy_pybind11 import RCLError
from rclpy.event_handler import PublisherEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSProfile

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message

__all__ = ["HeldPublisher"]

_MAX_HELD = 10
_DISCOVERY_S = 1.0
"""A new publisher holds its last `_MAX_HELD` messages until it has matched all subscribers, at most for this time.

They are published at the intervals at which they arrived: a button that was pressed and released during discovery was
pressed for that time.
"""

_NO_EVENTS = PublisherEventCallbacks(use_default_callbacks=False)
"""No event handlers: each would be one more entity that the executor waits for, in every iteration."""


class HeldPublisher:
    """A ROS publisher and the messages that it has not published yet. `flush` must be called until it returns True."""

    def __init__(
        self,
        node: Node,
        message_type: type[Message],
        topic: str,
        profile: QoSProfile,
        now_s: Callable[[], float] = time.monotonic,
    ) -> None:
        """Create the publisher. `now_s` is a monotonic clock, s. Raises what `create_publisher` raises."""
        self._node = node
        self._now_s = now_s
        self.topic, self.message_type = topic, message_type
        self._publisher: Any = node.create_publisher(message_type, topic, profile, event_callbacks=_NO_EVENTS)
        self._discovery_end_s = now_s() + _DISCOVERY_S
        self._held: deque[tuple[float, Message | bytes]] = deque(maxlen=_MAX_HELD)
        """Messages that are not published yet, with the time of arrival, s."""
        self._is_waiting = False
        """Whether messages are held because of discovery."""
        self._delay_s = self._matched_s = 0.0
        """Messages that arrived until `_matched_s`, the end of discovery, are published `_delay_s` after their arrival;
        later ones as soon as all earlier ones are published."""

    def publish(self, message: Message | bytes) -> bool:
        """Publish a message, or hold it; return whether none is held."""
        self._held.append((self._now_s(), message))
        return self.flush()

    def flush(self) -> bool:
        """Publish messages that are due, unless discovery is going on; return whether none is left."""
        now_s = self._now_s()
        if self._held and now_s < self._discovery_end_s and not self._has_matched_all():
            self._is_waiting = True
            return False
        if self._is_waiting:
            self._is_waiting, self._delay_s, self._matched_s = False, now_s - self._held[0][0], now_s
        while self._held:
            arrived_s, message = self._held[0]
            if arrived_s <= self._matched_s and arrived_s + self._delay_s > now_s:
                return False
            self._held.popleft()
            try:
                self._publisher.publish(message)
            except RCLError as error:  # above a bound of its type, which deserialization does not check
                self._node.get_logger().warning(f"{self.topic}: message of a client rejected: {error}")
        return True

    def destroy(self) -> None:
        """End the publisher; held messages are lost."""
        self._node.destroy_publisher(self._publisher)

    def _has_matched_all(self) -> bool:
        known = self._node.count_subscribers(self.topic)
        return bool(0 < known <= self._publisher.get_subscription_count())
