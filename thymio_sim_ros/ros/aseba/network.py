"""The Aseba network between runtimes in different processes: one topic; received events are never published again."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from rclpy.node import Node
from std_msgs.msg import Int16MultiArray

from thymio_sim_ros.ros.interface import convert_readings, qos
from thymio_sim_ros.ros.rclpy_ext.message_reports import MessageReports

__all__ = ["TOPIC", "AsebaNetwork", "NetworkEvent"]

TOPIC = "_aseba/network"
"""Relative: connects the runtimes of one namespace."""
HEAD = 3


@dataclass(frozen=True, slots=True)
class NetworkEvent:
    """A global event: name, sender number (0 is a computer), radio channel and network, values."""

    event: str
    source: int
    radio: tuple[int, int]
    args: tuple[int, ...]


class AsebaNetwork:
    """Exchanges events with other runtimes."""

    def __init__(self, node: Node, on_event: Callable[[NetworkEvent], None], messages: MessageReports) -> None:
        """`on_event` is called with each received event."""
        self._on_event, self._messages = on_event, messages
        self._own = uuid.uuid4().hex
        self._publisher = node.create_publisher(Int16MultiArray, TOPIC, qos.EVENTS)
        node.create_subscription(Int16MultiArray, TOPIC, self._on_message, qos.EVENTS)

    @property
    def has_others(self) -> bool:
        """Whether other runtimes are subscribed."""
        return self._publisher.get_subscription_count() > 1

    def send(self, event_message: NetworkEvent) -> None:
        """Publish an event if there are other runtimes."""
        if self.has_others:
            data = [event_message.source, *event_message.radio, *event_message.args]
            labels = [(event_message.event, len(data)), (self._own, 0)]
            self._publisher.publish(Int16MultiArray(layout=convert_readings.layout(labels), data=data))

    def _on_message(self, message: Int16MultiArray) -> None:
        labels: Sequence[str] = [dimension.label for dimension in message.layout.dim]
        if len(labels) != 2 or len(message.data) < HEAD:
            found = f"found {len(labels)} labels and {len(message.data)} values"
            self._messages.add_rejected(self._publisher.topic_name, f"{found}, expected 2 and 3 or more")
        elif labels[1] != self._own:
            source, channel, network, *args = message.data
            self._on_event(NetworkEvent(labels[0], source, (channel, network), tuple(args)))
