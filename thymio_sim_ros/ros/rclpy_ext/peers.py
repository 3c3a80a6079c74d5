"""Nodes of further DDS participants in the process, for processes whose endpoints do not match each other.

The nodes of a suite have more endpoints than DDS can compare with each other in a short time, so those of one
participant are not compared at all (`compat/dds_profile.py`). A node reaches the others of its process through a peer,
a hidden node of another participant.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol, cast, runtime_checkable

import rclpy
from rclpy.clock import ROSClock
from rclpy.context import Context
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.signals import SignalHandlerOptions
from rclpy.subscription import Subscription
from rclpy.time import Time
from rosgraph_msgs.msg import Clock

from thymio_sim_ros.ros.rclpy_ext.callback_groups import forget_destroyed

__all__ = ["PUBLISHING_PEER", "SUBSCRIBING_PEER", "HasPeers", "PeerContext", "follow_clock"]

SUBSCRIBING_PEER, PUBLISHING_PEER = "_foxglove_subscriber", "_foxglove_publisher"
"""The peers of the bridge in a suite."""

_CLOCK_QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
"""QoS of the time source of rclpy."""


@runtime_checkable
class HasPeers(Protocol):
    """A runnable node with peers, which its executor spins too."""

    @property
    def peers(self) -> Sequence[Node]:
        """The peers."""


class PeerContext:
    """A context, and so a participant, of its own. Its nodes do not match each other either."""

    def __init__(self, args: Sequence[str], domain_id: int | None = None) -> None:
        """`args`: the ROS arguments of the process. `domain_id`: None for that of the environment."""
        self._args, self._domain_id = list(args), domain_id
        self._context = Context()
        self._nodes: list[Node] = []

    def node(self, name: str) -> Node:
        """Create a node that only publishes and subscribes; `name` begins with `_`, which hides it from tools."""
        if not self._nodes:
            rclpy.init(
                args=self._args,
                context=self._context,
                domain_id=self._domain_id,
                signal_handler_options=SignalHandlerOptions.NO,
            )
        created = Node(
            name,
            context=self._context,
            enable_rosout=False,
            start_parameter_services=False,
            parameter_overrides=[Parameter("start_type_description_service", value=False)],
        )
        forget_destroyed(created)
        self._nodes.append(created)
        return created

    def close(self) -> None:
        """Destroy all nodes and the participant."""
        for node in self._nodes:
            node.destroy_node()
        self._nodes.clear()
        self._context.try_shutdown()


def follow_clock(node: Node, peer: Node) -> Subscription:
    """Set the simulated time of a node from the clock that its peer receives; return the subscription."""

    clock = cast(ROSClock, node.get_clock())

    def set_time(message: Clock) -> None:
        clock.set_ros_time_override(Time.from_msg(message.clock))

    return peer.create_subscription(Clock, "/clock", set_time, _CLOCK_QOS)
