"""Publishes the commands of an Aseba program, again for late subscribers where needed.

The topics are volatile and discovery takes time: without re-sending, the first commands of a program would be lost to a
robot that is discovered later or was restarted.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from geometry_msgs.msg import Twist
from rclpy.node import Node
from rclpy.publisher import Publisher

from thymio_sim_ros.ros.aseba.outside import driver_input
from thymio_sim_ros.ros.interface import command_topics, driver_topics, plugin_topics, qos
from thymio_sim_ros.ros.interface.names import RobotNames
from thymio_sim_ros.ros.rclpy_ext.subscription_count import counter
from thymio_sim_ros.sim.commands import Command, SetLed, ShowOnLeds

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.messages.message_class import Message

__all__ = ["OutputEndpoints"]

FRESH_S = 10.0
"""Time after the start of a program during which retained commands are re-sent to every new subscriber, even if there
was one before: discovery reports a killed robot as a subscriber for a while."""


@dataclass(frozen=True, slots=True)
class _CommandPublisher:
    """The publisher of a command topic with its encoder and its count of subscriptions."""

    encode: Callable[[Any], Message]
    publisher: Publisher[Message]
    count: Callable[[], int]
    is_retained: bool


@dataclass(slots=True)
class _SentCommand:
    """A sent message, the number of current subscribers that may have received it, and whether to send it again."""

    message: Message
    receivers: int
    is_due: bool = False


class OutputEndpoints:
    """Publishers of the commands of one robot."""

    def __init__(self, node: Node, names: RobotNames) -> None:
        """The topics are those of the ROS driver; the wheels are driven by `cmd_vel`."""
        self._node = node
        self._publishers: dict[str, _CommandPublisher] = {}
        self._sent: dict[tuple[str, Hashable], _SentCommand] = {}
        """By topic and part of the topic (such as one LED), in the order of sending."""
        self._fresh_until_s = 0.0
        for row in (*command_topics.ROWS, *plugin_topics.rows()):
            if row.encode is None:
                continue
            is_wheels = row.topic == "_motor/target"
            topic = "cmd_vel" if is_wheels else driver_topics.driver_name(row.topic)
            kind: type[Message] = Twist if is_wheels else row.type
            publisher = node.create_publisher(kind, names.topic(topic), qos.COMMAND if is_wheels else row.profile)
            self._publishers[row.topic] = _CommandPublisher(
                driver_input.twist_of if is_wheels else row.encode,
                publisher,
                counter(publisher),
                row.is_retained,
            )
        self._counts = self._count()

    def start_program(self) -> None:
        """Note that a program starts."""
        self._fresh_until_s = time.monotonic() + FRESH_S
        self._counts = self._count()

    def send(self, command: Command) -> None:
        """Publish a command; commands without a topic are ignored."""
        topic = _topic(command)
        if topic is None:
            return
        publisher = self._publishers[topic]
        sent = _SentCommand(publisher.encode(command), publisher.count())
        publisher.publisher.publish(sent.message)
        key = (topic, _part(command))
        self._sent.pop(key, None)
        if publisher.is_retained or not sent.receivers:
            self._sent[key] = sent

    def resend(self) -> None:
        """Send retained and unreceived commands again to new subscribers.

        Waits until discovery is quiet (no change of counts since the last poll), so that the original order is kept.
        """
        before, self._counts = self._counts, self._count()
        is_fresh = time.monotonic() < self._fresh_until_s
        for (topic, _), sent in self._sent.items():
            count = self._counts[topic]
            is_unreceived = not sent.receivers and count > 0
            sent.is_due |= is_unreceived or (is_fresh and count > before[topic])
            sent.receivers = min(sent.receivers, count)
        if self._counts == before:
            for (topic, part), sent in [(key, sent) for key, sent in self._sent.items() if sent.is_due]:
                publisher = self._publishers[topic]
                publisher.publisher.publish(sent.message)
                sent.receivers, sent.is_due = self._counts[topic], False
                if not publisher.is_retained:
                    del self._sent[topic, part]

    def close(self) -> None:
        """Destroy the topics."""
        for publisher in self._publishers.values():
            self._node.destroy_publisher(publisher.publisher)

    def _count(self) -> dict[str, int]:
        """Return the number of subscriptions by topic."""
        return {topic: publisher.count() for topic, publisher in self._publishers.items()}


def _topic(command: Command) -> str | None:
    return command_topics.topic_of(command) or plugin_topics.topic_of(command)


def _part(command: Command) -> Hashable:
    """Return the part of a topic that a command sets, if it does not replace all earlier commands of the topic."""
    if isinstance(command, ShowOnLeds):
        return command.group
    return command.number if isinstance(command, SetLed) else None
