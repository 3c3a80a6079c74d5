"""Barrier: marks by which one process knows that all earlier messages of another one have arrived.

A participant of DDS receives the messages of another one in the order in which they were published, since all come in
by one port and are read by one thread. So when a mark has arrived, everything published before it has arrived too,
whatever its topic and its reliability (docs/decisions.md).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rclpy.context import Context
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile
from std_msgs.msg import String

from thymio_sim_ros.lockstep import real_time
from thymio_sim_ros.lockstep.matching import TURNS

__all__ = ["Barrier"]

_QOS = QoSProfile(depth=1000)


class Barrier:
    """The marks of one participant. No executor spins its node."""

    def __init__(self, context: Context, source: str) -> None:
        """`source`: a name that no other participant of this test has."""
        self.source = source
        self.sent = 0
        self.context = context
        self._received: dict[str, int] = {}
        self.node = Node(
            f"_turns_{source}",
            context=context,
            namespace="/",
            use_global_arguments=False,
            enable_rosout=False,
            start_parameter_services=False,
            parameter_overrides=[Parameter("start_type_description_service", value=False)],
        )
        self._publisher = self.node.create_publisher(String, TURNS, _QOS)
        self._subscription = self.node.create_subscription(String, TURNS, self._ignore, _QOS)

    def mark(self) -> None:
        """Publish a mark: messages that are published before it arrive before it."""
        self.sent += 1
        self._publisher.publish(String(data=f"{self.source} {self.sent}"))

    def wait(self, marks: Mapping[str, int]) -> None:
        """Wait until these marks of other participants have arrived. Raises NotAnsweredError."""
        wanted = {source: mark for source, mark in marks.items() if source != self.source}
        try:
            real_time.wait_for(lambda: self._has(wanted), f"the messages of {', '.join(wanted)}")
        except real_time.NotAnsweredError as error:
            raise real_time.NotAnsweredError(f"{error}; {self._missing(wanted)}") from error

    def _missing(self, wanted: Mapping[str, int]) -> str:
        marks = ", ".join(f"{self._received.get(source, 0)} of {mark} from {source}" for source, mark in wanted.items())
        known, matched = self.node.count_publishers(TURNS), self._subscription.get_publisher_count()
        return f"{self.source} has received marks {marks}, and is matched with {matched} of {known} publishers"

    def _has(self, wanted: Mapping[str, int]) -> bool:
        while mark_message := self._take():
            source, _, mark = mark_message.rpartition(" ")
            self._received[source] = int(mark)
        return all(self._received.get(source, 0) >= mark for source, mark in wanted.items())

    def _take(self) -> str:
        with self._subscription.handle:
            handle: Any = self._subscription.handle  # of the compiled part of rclpy
            mark_message = handle.take_message(String, False)  # not raw
        return "" if mark_message is None else str(mark_message[0].data)

    def _ignore(self, _message: String) -> None:
        pass
