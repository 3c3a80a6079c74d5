"""Detects publishers with the wrong type on topics that a node subscribes to; ROS silently does not connect them.

The usual case is a TwistStamped on `cmd_vel`, as published by newer teleoperation nodes and Nav2. The graph is queried
per node, because there are fewer nodes than topics; the period depends on the cost of the query.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from rclpy.node import Node, NodeNameNonExistentError

from thymio_sim_ros.type_names import type_name

__all__ = ["Mismatch", "TypeMismatches"]

SHARE = 0.002
"""Largest share of one core that polling may use."""
POLL_PERIOD_S = 1.0
"""Shortest wall time between two polls."""
VELOCITY, STAMPED_PARAMETER = "cmd_vel", "stamped_cmd_vel"


@dataclass(frozen=True, slots=True)
class Mismatch:
    """A publisher whose messages never arrive: fully qualified topic and node, types as `package/msg/Name`."""

    topic: str
    node: str
    found: str
    expected: str
    cure: str

    def __str__(self) -> str:
        return (
            f"{self.topic} has a publisher of {self.found} by node {self.node}; expected {self.expected}: its messages"
            f" never arrive. {self.cure}"
        )


class TypeMismatches:
    """Finds mismatched publishers on the subscribed topics of a node, and warns once about each."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._subscriptions: list[Any] = []
        self._expected: dict[str, str] = {}
        self._next_s = 0.0
        self.mismatches: tuple[Mismatch, ...] = ()
        """Result of the last poll."""

    def poll(self) -> None:
        """Query the graph if it is time, and warn about new mismatches."""
        began_s = time.monotonic()
        if began_s < self._next_s:
            return
        before, self.mismatches = self.mismatches, self._find()
        for mismatch in self.mismatches:
            if mismatch not in before:
                self._node.get_logger().warning(str(mismatch))
        ended_s = time.monotonic()
        self._next_s = ended_s + max(POLL_PERIOD_S, (ended_s - began_s) / SHARE)

    def status(self) -> DiagnosticStatus:
        """Return the entry for `/diagnostics`: WARN while there is a mismatch."""
        count = len(self.mismatches)
        return DiagnosticStatus(
            level=DiagnosticStatus.WARN if count else DiagnosticStatus.OK,
            name=f"{self._node.get_name()}: inputs",
            hardware_id="thymio_sim_ros",
            message=str(self.mismatches[0]) if count else "all publishers have the expected types",
            values=[KeyValue(key=one.topic, value=str(one)) for one in self.mismatches],
        )

    def _find(self) -> tuple[Mismatch, ...]:
        expected = self._inputs()
        own = (self._node.get_name(), self._node.get_namespace())
        found = {}
        for name, namespace in dict.fromkeys(self._node.get_node_names_and_namespaces()):
            if (name, namespace) == own:
                continue
            try:
                published = self._node.get_publisher_names_and_types_by_node(name, namespace)
            except NodeNameNonExistentError:  # the node has just ended
                continue
            for topic, types in published:
                wanted = expected.get(topic)
                for one in types:
                    if wanted is not None and one != wanted:
                        publisher = f"{namespace.rstrip('/')}/{name}"
                        found[topic, publisher, one] = Mismatch(
                            topic, publisher, one, wanted, cure(topic, one, wanted, expected)
                        )
        return tuple(found.values())

    def _inputs(self) -> Mapping[str, str]:
        """Return the types of all topics that the node is subscribed to."""
        subscriptions = list(self._node.subscriptions)
        if subscriptions != self._subscriptions:
            self._subscriptions = subscriptions
            self._expected = {one.topic_name: type_name(one.msg_type) for one in subscriptions}
        return self._expected


def cure(topic: str, found: str, wanted: str, inputs: Mapping[str, str]) -> str:
    """Return advice for a publisher of `found` on a topic of type `wanted`; `inputs`: types by subscribed topic."""
    space, _, word = topic.rpartition("/")
    family = VELOCITY if word.startswith(VELOCITY) else word
    others = [name for name, kind in inputs.items() if kind == found and name.startswith(f"{space}/{family}")]
    if not others:
        return f"Publish {wanted} there"
    option = f", or start the simulator with {STAMPED_PARAMETER}:=true" if found.endswith("TwistStamped") else ""
    return f"Publish it on {others[0]}{option if word == VELOCITY else ''}"
