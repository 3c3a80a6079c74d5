"""The lines of a node's log on `/rosout`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.rclpy.constants import S_TO_NS
from thymio_sim_ros.portable_ros.rclpy.duration import Duration
from thymio_sim_ros.portable_ros.rclpy.impl.rcutils_logger import add_sink, remove_sink
from thymio_sim_ros.portable_ros.rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.rclpy_parts.node_endpoints import NodeEndpoints

__all__ = ["Rosout"]

_TOPIC = "/rosout"
_PROFILE = QoSProfile(
    history=HistoryPolicy.KEEP_LAST,
    depth=1000,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
    lifespan=Duration(seconds=10),
)


class Rosout:
    """Publishes what a node logs."""

    def __init__(self, node: NodeEndpoints) -> None:
        self._context, self._name = node.context, node.get_logger().name
        self._publisher = node.create_publisher(ros_types.Log, _TOPIC, _PROFILE)
        self._publisher.is_part = True
        add_sink(self._name, self._publish)

    def close(self) -> None:
        """Publish no more."""
        remove_sink(self._name)

    def _publish(self, name: str, level: int, text: str, time_ns: int, place: tuple[str, str, int]) -> None:
        if not self._context.ok():
            return
        seconds, nanoseconds = divmod(time_ns, S_TO_NS)
        message = ros_types.Log(level=level, name=name, msg=text, file=place[0], function=place[1], line=place[2])
        message.stamp.sec, message.stamp.nanosec = seconds, nanoseconds
        self._publisher.publish(message)
