"""Subscriptions."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from enum import Enum
from typing import TYPE_CHECKING, Any, TypeAlias

from thymio_sim_ros.portable_ros.graph.entity import Entity
from thymio_sim_ros.portable_ros.graph.event_queue import EventQueue
from thymio_sim_ros.portable_ros.messages import cdr
from thymio_sim_ros.portable_ros.messages.message_class import Message
from thymio_sim_ros.portable_ros.rclpy.callback_groups import CallbackGroup
from thymio_sim_ros.portable_ros.rclpy.qos import QoSProfile

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.graph.endpoint_events import EndpointEvents
    from thymio_sim_ros.portable_ros.graph.protocols import PublisherEnd, Sample

__all__ = ["MessageInfo", "Subscription"]

MessageInfo: TypeAlias = dict[str, int | None]


class Subscription(Entity):
    """Receives the messages of all matched publishers; each call gets a message of its own."""

    class CallbackType(Enum):
        """What a callback gets: a message, or a message and facts about it."""

        MessageOnly = 0
        WithMessageInfo = 1

    def __init__(
        self,
        msg_type: type[Message],
        topic: str,
        topic_name: str,
        callback: Callable[..., object],
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
        raw: bool,
        events: EndpointEvents,
        logger_name: str,
    ) -> None:
        """`topic` is the name that the program gave, `topic_name` the full one."""
        super().__init__(callback_group)
        self.msg_type, self.topic, self.qos_profile, self.raw = msg_type, topic, qos_profile, raw
        self.events, self.event_handlers = events, events.handlers
        self._topic_name, self._logger_name = topic_name, logger_name
        self.matched: tuple[PublisherEnd, ...] = ()
        self._queue: EventQueue[Sample] = EventQueue(qos_profile.kept)
        self.callback = callback

    @property
    def topic_name(self) -> str:
        """The full name of the topic."""
        with self._handle:
            return self._topic_name

    @property
    def logger_name(self) -> str:
        """The name of the log of the node."""
        with self._handle:
            return self._logger_name

    @property
    def callback(self) -> Callable[..., object]:
        """What is called for each message. Raises RuntimeError for a function that takes neither one nor two values."""
        return self._callback

    @callback.setter
    def callback(self, value: Callable[..., object]) -> None:
        self._callback = value
        if _accepts(value, 1):
            self._callback_type = Subscription.CallbackType.MessageOnly
        elif _accepts(value, 2):
            self._callback_type = Subscription.CallbackType.WithMessageInfo
        else:
            raise RuntimeError(
                "Subscription.__init__(): callback should be either be callable with one argument(to get only the"
                " message) or two (to get message and message info)"
            )

    def destroy(self) -> None:
        """Receive no more. Nodes have `destroy_subscription`."""
        self.events.destroy()
        super().destroy()

    def get_publisher_count(self) -> int:
        """The number of matched publishers."""
        with self._handle:
            return len(self.matched)

    def receive(self, sample: Sample) -> None:
        """Queue a serialized message."""
        self.events.note_message()
        if self._queue.put(sample):
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
        sample = self._queue.get()
        if sample is None:
            return None
        message = sample.data if self.raw else cdr.deserialize(sample.data, self.msg_type)
        if self._callback_type is Subscription.CallbackType.MessageOnly:
            return self._callback, (message,)
        info: MessageInfo = {
            "source_timestamp": sample.source_timestamp,
            "received_timestamp": sample.source_timestamp,
            "publication_sequence_number": sample.sequence_number,
            "reception_sequence_number": None,
        }
        return self._callback, (message, info)


def _accepts(callback: Callable[..., object], count: int) -> bool:
    """Whether a callback can be called with so many arguments."""
    try:
        inspect.signature(callback).bind(*[None] * count)
    except TypeError:
        return False
    except ValueError:  # a built-in function without a signature
        return count == 1
    return True
