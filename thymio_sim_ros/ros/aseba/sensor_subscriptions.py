"""The subscriptions by which the device of one robot gets its readings."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rclpy.node import Node
from std_msgs.msg import Int16MultiArray

from thymio_sim_ros.device.bindings import sensor_names
from thymio_sim_ros.ros.aseba import driver_input
from thymio_sim_ros.ros.aseba.driver_input import Feed
from thymio_sim_ros.ros.aseba.simulator_link import SimulatorLink
from thymio_sim_ros.ros.interface import qos
from thymio_sim_ros.ros.interface.names import RobotNames, raw_topic
from thymio_sim_ros.ros.rclpy_ext import raw_publisher

__all__ = ["SensorSubscriptions"]


class SensorSubscriptions:
    """Subscribes to `_raw/<sensor>` or to the topics of the ROS driver; to nothing while the owner feeds readings."""

    def __init__(
        self,
        node: Node,
        names: RobotNames,
        on_reading: Feed,
        *,
        has_driver: bool,
        is_fed: bool,
        link: SimulatorLink | None = None,
    ) -> None:
        """`has_driver`: the robot has the topics of the ROS driver, which are always used."""
        self._own_node, self._link, self._names, self._on_reading = node, link, names, on_reading
        self._has_driver, self._is_fed = has_driver, is_fed
        self._subscriptions = self._subscribe()

    @property
    def _node(self) -> Node:
        return self._own_node if self._link is None else self._link.inputs

    @property
    def is_fed(self) -> bool:
        """Whether the owner feeds readings; otherwise these subscriptions do."""
        return self._is_fed

    @is_fed.setter
    def is_fed(self, is_fed: bool) -> None:
        if is_fed != self._is_fed:
            self.close()
            self._is_fed = is_fed
            self._subscriptions = self._subscribe()

    def close(self) -> None:
        """Destroy the subscriptions."""
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)

    def _subscribe(self) -> list[Any]:
        if self._has_driver:
            return driver_input.subscribe(self._node, self._names, self._on_reading)
        if self._is_fed:
            return []
        return [
            self._node.create_subscription(
                Int16MultiArray, self._names.topic(raw_topic(sensor)), self._feeder(sensor), qos.SENSOR, raw=True
            )
            for sensor in sensor_names()
        ]

    def _feeder(self, sensor: str) -> Callable[[bytes], None]:
        return lambda message: self._on_reading(sensor, raw_publisher.words_of(message))
