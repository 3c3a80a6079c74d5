"""Subscriptions."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from thymio_sim_ros.portable_ros.graph.entity import Entity
from thymio_sim_ros.portable_ros.graph.event_queue import EventQueue
from thymio_sim_ros.portable_ros.messages import cdr
from thymio_sim_ros.portable_ros.rclpy.callback_groups import CallbackGroup
from thymio_sim_ros.portable_ros.rclpy.qos import QoSProfile

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.graph.endpoint_events import EndpointEvents
    from thymio_sim_ros.portable_ros.graph.protocols import PublisherEnd

__all__ = ["Subscription"]


class Subscription(Entity):
    """Receives the messages of all matched publishers; each call gets a message of its own."""

    def __init__(
        self,
        msg_type: Any,
        topic: str,
        callback: Callable[..., Any],
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
        raw: bool,
        events: EndpointEvents,
        logger_name: str,
    ) -> None:
        super().__init__(callback_group)
        self.msg_type, self.topic, self.raw = msg_type, topic, raw
        self.qos_profile, self.events = qos_profile, events
        self._logger_name = logger_name
        self.matched: tuple[PublisherEnd, ...] = ()
        self._queue: EventQueue[bytes] = EventQueue(qos_profile.kept)
        self.callback = callback

    @property
    def topic_name(self) -> str:
        """The full name of the topic."""
        return self.topic

    @property
    def logger_name(self) -> str:
        """The name of the log of the node."""
        return self._logger_name

    @property
    def callback(self) -> Callable[..., Any]:
        """What is called for each message."""
        return self._callback

    @callback.setter
    def callback(self, value: Callable[..., Any]) -> None:
        self._callback = value
        self._has_info = _accepts(value, 2) and not _accepts(value, 1)

    def get_publisher_count(self) -> int:
        """The number of matched publishers."""
        with self._handle:
            return len(self.matched)

    def receive(self, data: bytes) -> None:
        """Queue a serialized message."""
        if self._queue.put(data):
            self.notify()

    def add_match(self, publisher: PublisherEnd) -> None:
        """Expect messages of a publisher."""
        self.matched = (*self.matched, publisher)

    def unmatch(self, publisher: PublisherEnd) -> None:
        """Expect no more messages of a publisher."""
        self.matched = tuple(one for one in self.matched if one is not publisher)
        self.events.report_match(-1)

    def pending(self) -> int:
        """The number of waiting messages."""
        return len(self._queue)

    def take(self) -> tuple[Callable[..., Any], tuple[Any, ...]] | None:
        """Take a message."""
        data = self._queue.get()
        if data is None:
            return None
        message = data if self.raw else cdr.deserialize(data, self.msg_type)
        return self._callback, ((message, {}) if self._has_info else (message,))


def _accepts(callback: Callable[..., Any], count: int) -> bool:
    """Whether a callback can be called with so many arguments."""
    try:
        inspect.signature(callback).bind(*[None] * count)
    except TypeError:
        return False
    except ValueError:  # a built-in function without a signature
        return count == 1
    return True
