"""Follows a simulator in the same namespace: its robots, and their readings in one topic."""

from __future__ import annotations

import json
from typing import Any

from rclpy.node import Node
from std_msgs.msg import Int16MultiArray, String

from thymio_sim_ros.device.bindings import sensor_names
from thymio_sim_ros.ros.aseba.device_endpoints import DeviceEndpoints
from thymio_sim_ros.ros.aseba.parameters import RuntimeParams
from thymio_sim_ros.ros.aseba.robot_set import ROBOT_ERRORS, RobotSet
from thymio_sim_ros.ros.aseba.simulator_link import SimulatorLink
from thymio_sim_ros.ros.interface import qos
from thymio_sim_ros.ros.interface.names import full_name
from thymio_sim_ros.ros.interface.raw_topic import RawDecoder
from thymio_sim_ros.ros.rclpy_ext.message_reports import MessageReports

__all__ = ["SimulatorFollower"]

SIMULATOR_STATE, SIMULATOR_RAW = "simulator/_state", "simulator/_raw"
"""Relative names: topics of the simulator in the same namespace."""

_SENSORS = frozenset(sensor_names())


class SimulatorFollower:
    """Subscribes to the simulator; without one, or with `follow_simulator` off, robots have their own subscriptions.

    A real robot needs neither.
    """

    def __init__(
        self,
        node: Node,
        params: RuntimeParams,
        robots: RobotSet,
        link: SimulatorLink | None,
        messages: MessageReports,
    ) -> None:
        """Subscribe to the readings of all robots if a simulator publishes them already.

        The first robots are then created without subscriptions of their own, which the state would replace.
        """
        self._node, self._robots, self._link = node, robots, link
        self._is_on = params.follow_simulator and not params.robot
        self._has_driver = params.robot_topics == "driver"
        self._raw: Any = None
        """The subscription to the integer readings of all robots of the simulator."""
        self._decoder, self._messages = RawDecoder(), messages
        if self._is_on and not self._has_driver and node.count_publishers(SIMULATOR_RAW):
            if link is None:
                self._subscribe_raw(SIMULATOR_RAW)
            else:
                self._robots.feed(True)

    @property
    def _inputs(self) -> Node:
        """The node that subscribes."""
        return self._node if self._link is None else self._link.inputs

    def start(self) -> None:
        """Follow the robots of the simulator's state, unless `follow_simulator` is off."""
        if self._is_on:
            self._inputs.create_subscription(String, SIMULATOR_STATE, self._on_state, qos.TRANSIENT_LOCAL)

    def check_publisher(self) -> None:
        """Return to the topics of each robot if the simulator has ended."""
        if self._raw is not None and not self._node.count_publishers(self._raw.topic_name):
            self._subscribe_raw("")

    def _on_state(self, message: String) -> None:
        try:
            state = json.loads(message.data)
            names, raw = [str(robot["name"]) for robot in state["robots"]], str(state.get("raw", ""))
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
            self._messages.add_rejected(full_name(self._node, SIMULATOR_STATE), repr(error))
            return
        self._subscribe_raw("" if self._has_driver else raw)
        if names != self._robots.names:
            try:
                self._robots.set_names(names)
            except ROBOT_ERRORS as error:
                self._node.get_logger().error(f"robots {', '.join(names)}: {error}")

    def _subscribe_raw(self, topic: str) -> None:
        """Subscribe to the readings of all robots in one topic; "" selects one topic per robot and sensor."""
        topic = topic and self._node.resolve_topic_name(topic)
        if self._raw is not None and self._raw.topic_name != topic:
            self._inputs.destroy_subscription(self._raw)
            self._raw = None
        if self._raw is None and topic:
            self._raw = self._inputs.create_subscription(Int16MultiArray, topic, self._on_raw, qos.EVENTS, raw=True)
        self._robots.feed(self._raw is not None)

    def _on_raw(self, data: bytes) -> None:
        """Feed all readings of one tick, then run robots with work to do, in the order of headless runs."""
        robots = {endpoints.names.name: endpoints for endpoints in self._robots if endpoints.is_fed}
        fed: dict[DeviceEndpoints, None] = {}
        try:
            for robot, sensor, words in self._decoder.decode(data):
                if robot in robots and sensor in _SENSORS:
                    robots[robot].feed(sensor, words)
                    fed[robots[robot]] = None
        except (ValueError, RuntimeError) as error:
            self._messages.add_rejected(full_name(self._node, SIMULATOR_RAW), error)
        now_ns = self._node.get_clock().now().nanoseconds
        self._robots.bus.run_until_idle(*[endpoints for endpoints in fed if endpoints.is_due(now_ns)])
