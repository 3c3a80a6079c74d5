"""Topics for the events of one robot's program, in both directions (docs/spec/ros-interface.md section 6.1)."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence

from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.subscription import Subscription
from std_msgs.msg import Int16MultiArray

from thymio_sim_ros.device.behavior_host import is_internal
from thymio_sim_ros.device.programs.program import ThymioProgram
from thymio_sim_ros.ros.interface import convert_readings, qos
from thymio_sim_ros.ros.interface.names import RobotNames, full_name, topic_word
from thymio_sim_ros.ros.rclpy_ext.message_reports import MessageReports

__all__ = ["Emit", "EventEndpoints", "unique_topic_words"]

Emit = Callable[[str, list[int]], None]
"""Receives an event emitted from ROS: name, values."""

_MAX_TOPIC_LENGTH = 247
"""Largest length of a full topic name in characters, a limit of DDS."""


class EventEndpoints:
    """A pair of topics for all events, and a pair for each event of the current program."""

    def __init__(
        self, node: Node, names: RobotNames, emit: Emit, *, warn: Callable[[str, str], None], messages: MessageReports
    ) -> None:
        self.words: Mapping[str, str] = {}
        self._node = node
        self._names = names
        self._emit = emit
        self._warn, self._messages = warn, messages
        self._any = node.create_publisher(Int16MultiArray, names.topic("_aseba/events"), qos.EVENTS)
        self._any_emit = node.create_subscription(
            Int16MultiArray, names.topic("_aseba/emit"), self._on_any_emit, qos.EVENTS
        )
        self._publishers: dict[str, Publisher[Int16MultiArray]] = {}
        self._subscriptions: list[Subscription] = []

    @property
    def has_subscribers(self) -> bool:
        """Whether another node receives events."""
        return any(publisher.get_subscription_count() for publisher in (self._any, *self._publishers.values()))

    def open(self, program: ThymioProgram, local_events: Collection[str]) -> None:
        """Create the topics for the events of a program and for these local events."""
        self._close_program()
        events = [event for event, _ in program.events if not is_internal(event)]
        self.words, unfit = unique_topic_words([*events, *local_events], self._topic)
        for event, why in unfit.items():
            self._warn(f"event {event}", f"{why}: use _aseba/events and _aseba/emit")
        for event, word in self.words.items():
            self._publishers[event] = self._node.create_publisher(Int16MultiArray, self._topic(word), qos.EVENTS)
            if event in events:
                topic = self._names.topic(f"aseba/emit/{word}")
                subscription = self._node.create_subscription(Int16MultiArray, topic, self._emitter(event), qos.EVENTS)
                self._subscriptions.append(subscription)

    def publish(self, event: str, args: Sequence[int]) -> None:
        """Publish an event that the robot emitted, or a local event."""
        data = list(args)
        self._any.publish(Int16MultiArray(layout=convert_readings.layout([(event, len(data))]), data=data))
        publisher = self._publishers.get(event)
        if publisher is not None:
            publisher.publish(Int16MultiArray(data=data))

    def close(self) -> None:
        """Destroy all topics."""
        self._close_program()
        self._node.destroy_publisher(self._any)
        self._node.destroy_subscription(self._any_emit)

    def _close_program(self) -> None:
        for publisher in self._publishers.values():
            self._node.destroy_publisher(publisher)
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)
        self._publishers.clear()
        self._subscriptions.clear()

    def _topic(self, word: str) -> str:
        return full_name(self._node, self._names.topic(f"aseba/events/{word}"))

    def _emitter(self, event: str) -> Callable[[Int16MultiArray], None]:
        return lambda message: self._emit(event, list(message.data))

    def _on_any_emit(self, message: Int16MultiArray) -> None:
        if len(message.layout.dim) != 1:
            topic = full_name(self._node, self._names.topic("_aseba/emit"))
            found = f"found {len(message.layout.dim)} dimensions, expected 1"
            self._messages.add_rejected(topic, f"{found}: layout.dim[0].label must be the name of the event")
            return
        self._emit(message.layout.dim[0].label, list(message.data))


def unique_topic_words(names: Sequence[str], topic: Callable[[str], str]) -> tuple[dict[str, str], dict[str, str]]:
    """Return topic words by name for names with a unique, valid topic, and the reason for each other name.

    `topic` returns the full topic name for a word.
    """
    words = {name: topic_word(name) for name in names}
    taken = list(words.values())
    unfit = {}
    for name, word in words.items():
        if taken.count(word) > 1:
            unfit[name] = f"has the same topic name {word} as another"
        elif len(topic(word)) > _MAX_TOPIC_LENGTH:
            unfit[name] = "has a name that is too long for a topic"
    return {name: word for name, word in words.items() if name not in unfit}, unfit
