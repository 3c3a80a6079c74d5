"""What an Aseba program tells its robot: a publisher for each topic, and what a robot that listens later has to know.

These topics are volatile, and finding each other takes a while: what a program says in its first lines would be lost to
a robot that is found a moment later, or that was started again meanwhile.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
from typing import Any

from geometry_msgs.msg import Twist
from rclpy.node import Node

from thymio_sim_ros.ros.aseba import driver_input
from thymio_sim_ros.ros.interface import command_topics, driver_topics, plugin_topics, qos
from thymio_sim_ros.ros.interface.names import RobotNames
from thymio_sim_ros.ros.rclpy_ext import raw_publisher
from thymio_sim_ros.sim.commands import Command, SetLed, ShowOnLeds

__all__ = ["OutputPorts"]

FRESH_S = 10.0
"""For so long after a program began, whoever comes is told, even where somebody listened: a robot that was killed is
taken for one that listens for a while."""


@dataclass(frozen=True, slots=True)
class _Outlet:
    """The publisher of a topic, and how many listen."""

    encode: Callable[[Any], Any]
    publisher: Any
    count: Callable[[], int]
    holds: bool


@dataclass(slots=True)
class _Told:
    """A message, how many of those who listen now may have heard it, and whether somebody has come who has not."""

    message: Any
    listeners: int
    is_due: bool = False


class OutputPorts:
    """Publishers of one robot's commands."""

    def __init__(self, node: Node, names: RobotNames, *, has_driver: bool) -> None:
        """`has_driver`: wheels are told by `cmd_vel`, as the ROS driver wants it."""
        self._node = node
        self._outlets: dict[str, _Outlet] = {}
        self._told: dict[tuple[str, Hashable], _Told] = {}
        """By topic and what of it the message is about, in the order in which it was said."""
        self._fresh_until_s = 0.0
        for row in (*command_topics.ROWS, *plugin_topics.rows()):
            if row.encode is None:
                continue
            if has_driver and row.topic == "_motor/target":
                publisher = node.create_publisher(Twist, names.topic("cmd_vel"), qos.COMMAND)
                encode: Callable[[Any], Any] = driver_input.twist_of
            else:
                topic = driver_topics.driver_name(row.topic) if has_driver else row.topic
                publisher, encode = node.create_publisher(row.type, names.topic(topic), row.profile), row.encode
            self._outlets[row.topic] = _Outlet(encode, publisher, raw_publisher.counter(publisher), row.holds)
        self._counts = self._count()

    def begin(self) -> None:
        """A program begins."""
        self._fresh_until_s = time.monotonic() + FRESH_S
        self._counts = self._count()

    def send(self, command: Command) -> None:
        """Tell the robot; nothing for a command that has no topic."""
        topic = _topic(command)
        if topic is None:
            return
        outlet = self._outlets[topic]
        told = _Told(outlet.encode(command), outlet.count())
        outlet.publisher.publish(told.message)
        key = (topic, _part(command))
        self._told.pop(key, None)
        if outlet.holds or not told.listeners:
            self._told[key] = told

    def send_all(self, commands: Sequence[Command], *, latest: bool = False) -> int:
        """Send commands in order; `latest`: of those about the same thing the last only. How many were left out."""
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

    def look(self) -> None:
        """Tell those who have come what holds, and what nobody has heard: in the order of old, once no more come."""
        before, self._counts = self._counts, self._count()
        is_fresh = time.monotonic() < self._fresh_until_s
        for (topic, _), told in self._told.items():
            count = self._counts[topic]
            is_unheard = not told.listeners and count > 0
            told.is_due |= is_unheard or (is_fresh and count > before[topic])
            told.listeners = min(told.listeners, count)
        if self._counts == before:
            for (topic, part), told in [(key, told) for key, told in self._told.items() if told.is_due]:
                outlet = self._outlets[topic]
                outlet.publisher.publish(told.message)
                told.listeners, told.is_due = self._counts[topic], False
                if not outlet.holds:
                    del self._told[topic, part]

    def close(self) -> None:
        """Destroy the topics."""
        for outlet in self._outlets.values():
            self._node.destroy_publisher(outlet.publisher)

    def _count(self) -> dict[str, int]:
        """How many listen to each topic."""
        return {topic: outlet.count() for topic, outlet in self._outlets.items()}


def _topic(command: Command) -> str | None:
    return command_topics.topic_of(command) or plugin_topics.topic_of(command)


def _part(command: Command) -> Hashable:
    """What of its topic a command is about, where one does not replace all that was said before."""
    if isinstance(command, ShowOnLeds):
        return command.group
    return command.number if isinstance(command, SetLed) else None
