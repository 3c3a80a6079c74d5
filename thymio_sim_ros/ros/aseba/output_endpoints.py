"""Publishes the commands of an Aseba program, again for late subscribers where needed.

The topics are volatile and discovery takes time: without re-sending, the first commands of a program would be lost to a
robot that is discovered later or was restarted.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from geometry_msgs.msg import Twist
from rclpy.node import Node

from thymio_sim_ros.ros.aseba import driver_input
from thymio_sim_ros.ros.aseba.simulator_link import Post
from thymio_sim_ros.ros.interface import command_topics, driver_topics, plugin_topics, qos
from thymio_sim_ros.ros.interface.command_row import CommandRow
from thymio_sim_ros.ros.interface.names import RobotNames
from thymio_sim_ros.ros.rclpy_ext import raw_publisher
from thymio_sim_ros.sim.commands import Command, SetLed, ShowOnLeds

__all__ = ["OutputEndpoints"]

FRESH_S = 10.0
"""Time after the start of a program during which retained commands are re-sent to every new subscriber, even if there
was one before: discovery reports a killed robot as a subscriber for a while."""


@dataclass(frozen=True, slots=True)
class _CommandPublisher:
    """The publisher of a command topic with its encoder and its count of subscriptions.

    `post` passes messages to a simulator in the same process, which is one more receiver.
    """

    encode: Callable[[Any], Any]
    publisher: Any
    count_remote: Callable[[], int]
    is_retained: bool
    post: Callable[[Any], None] | None

    def count(self) -> int:
        """Return the number of receivers."""
        return self.count_remote() + (self.post is not None)

    def publish(self, message: Any) -> None:
        """Send a message to all receivers."""
        if self.post is not None:
            self.post(message)
            if not self.count_remote():
                return
        self.publisher.publish(message)


@dataclass(slots=True)
class _SentCommand:
    """A sent message, the number of current subscribers that may have received it, and whether to send it again."""

    message: Any
    receivers: int
    is_due: bool = False


class OutputEndpoints:
    """Publishers of the commands of one robot."""

    def __init__(
        self,
        node: Node,
        names: RobotNames,
        *,
        has_driver: bool,
        post: Post | None = None,
        rows: Sequence[CommandRow] | None = None,
    ) -> None:
        """`has_driver`: drive the wheels by `cmd_vel`, as the ROS driver expects; `post`: to a simulator in the same
        process whose endpoints do not match those of `node`; `rows`: the commands, None for all.
        """
        self._node = node
        self._publishers: dict[str, _CommandPublisher] = {}
        self._sent: dict[tuple[str, Hashable], _SentCommand] = {}
        """By topic and part of the topic (such as one LED), in the order of sending."""
        self._fresh_until_s = 0.0
        for row in (*command_topics.ROWS, *plugin_topics.rows()) if rows is None else rows:
            if row.encode is None:
                continue
            if has_driver and row.topic == "_motor/target":
                topic = "cmd_vel"
                publisher = node.create_publisher(Twist, names.topic(topic), qos.COMMAND)
                encode: Callable[[Any], Any] = driver_input.twist_of
            else:
                topic = driver_topics.driver_name(row.topic) if has_driver else row.topic
                publisher, encode = node.create_publisher(row.type, names.topic(topic), row.profile), row.encode
            self._publishers[row.topic] = _CommandPublisher(
                encode,
                publisher,
                raw_publisher.counter(publisher),
                row.is_retained,
                None if post is None else partial(post, names.name, topic),
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
        publisher.publish(sent.message)
        key = (topic, _part(command))
        self._sent.pop(key, None)
        if publisher.is_retained or not sent.receivers:
            self._sent[key] = sent

    def send_all(self, commands: Sequence[Command], *, latest: bool = False) -> int:
        """Publish commands in order and return how many were skipped.

        With `latest` only the last command for each topic and part is published.
        """
        kept = commands
        if latest:
            last: dict[Hashable, Command] = {}
            for command in commands:
                key = _topic(command), _part(command)
                last.pop(key, None)
                last[key] = command
            kept = list(last.values())
        for command in kept:
            self.send(command)
        return len(commands) - len(kept)

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
                publisher.publish(sent.message)
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
