"""The topics of a robot outside of this process: its readings come from them, and its commands go to them."""

from __future__ import annotations

from rclpy.node import Node

from thymio_sim_ros.ros.aseba.outside import driver_input
from thymio_sim_ros.ros.aseba.outside.driver_input import Feed
from thymio_sim_ros.ros.aseba.outside.output_endpoints import OutputEndpoints
from thymio_sim_ros.ros.interface.names import RobotNames

__all__ = ["OutsideRobot"]


class OutsideRobot:
    """Subscribes to the sensors of one robot and publishes its commands, by the topics of the ROS driver."""

    def __init__(self, node: Node, names: RobotNames, feed: Feed) -> None:
        """`feed` takes the readings."""
        self._node = node
        self.outputs = OutputEndpoints(node, names)
        self._subscriptions = driver_input.subscribe(node, names, feed)

    def close(self) -> None:
        """Destroy the topics."""
        self.outputs.close()
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)
