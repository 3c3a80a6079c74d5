"""The Aseba network between runtimes in different processes: one topic, and nothing that is heard is repeated."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from rclpy.node import Node
from std_msgs.msg import Int16MultiArray

from thymio_sim_ros.ros.interface import convert_readings, qos
from thymio_sim_ros.ros.rclpy_ext.throttled_log import ThrottledLog

__all__ = ["TOPIC", "AsebaNetwork", "NetworkEvent"]

TOPIC = "_aseba/network"
"""Relative: runtimes in one namespace hear each other."""
HEAD = 3


@dataclass(frozen=True, slots=True)
class NetworkEvent:
    """A global event on its way: sender's number (0 is a computer), its radio's channel and network, values."""

    event: str
    source: int
    radio: tuple[int, int]
    args: tuple[int, ...]


class AsebaNetwork:
    """Sends what happens here to other runtimes, and tells what comes from them."""

    def __init__(self, node: Node, hear: Callable[[NetworkEvent], None]) -> None:
        self._set_demand, self._warn = hear, ThrottledLog(node)
        self._own = uuid.uuid4().hex
        self._publisher = node.create_publisher(Int16MultiArray, TOPIC, qos.EVENTS)
        node.create_subscription(Int16MultiArray, TOPIC, self._on_message, qos.EVENTS)

    @property
    def has_others(self) -> bool:
        """Whether somebody else listens."""
        return self._publisher.get_subscription_count() > 1

    def send(self, event_message: NetworkEvent) -> None:
        """Tell the others, if there are any."""
        if self.has_others:
            data = [event_message.source, *event_message.radio, *event_message.args]
            labels = [(event_message.event, len(data)), (self._own, 0)]
            self._publisher.publish(Int16MultiArray(layout=convert_readings.layout(labels), data=data))

    def _on_message(self, message: Int16MultiArray) -> None:
        labels: Sequence[str] = [dimension.label for dimension in message.layout.dim]
        if len(labels) != 2 or len(message.data) < HEAD:
            found = f"{len(labels)} labels and {len(message.data)} values found"
            self._warn(self._publisher.topic_name, f"refused: {found}, expected 2 and 3 or more")
        elif labels[1] != self._own:
            source, channel, network, *args = message.data
            self._set_demand(NetworkEvent(labels[0], source, (channel, network), tuple(args)))
