"""Sets clocks to the time on `/clock` while `use_sim_time` is true."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.graph.time_base import simulated_ns
from thymio_sim_ros.portable_ros.rclpy.clock import ROSClock
from thymio_sim_ros.portable_ros.rclpy.clock_type import ClockType
from thymio_sim_ros.portable_ros.rclpy.parameter import Parameter
from thymio_sim_ros.portable_ros.rclpy.qos import QoSProfile, ReliabilityPolicy
from thymio_sim_ros.portable_ros.rclpy.time import Time
from thymio_sim_ros.portable_ros.rclpy_parts.node_endpoints import NodeEndpoints

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.rclpy.subscription import Subscription

__all__ = ["TimeSource"]

CLOCK_TOPIC = "/clock"
USE_SIM_TIME_NAME = "use_sim_time"


class TimeSource:
    """The source of time of a node and of clocks that are attached."""

    def __init__(self, *, node: NodeEndpoints | None = None) -> None:
        self._associated_clocks: set[ROSClock] = set()
        self._node_weak_ref: weakref.ref[NodeEndpoints] | None = None
        self._clock_sub: Subscription | None = None
        self._last_time_set = Time(clock_type=ClockType.ROS_TIME)
        self._ros_time_is_active = False
        if node is not None:
            self.attach_node(node)

    @property
    def ros_time_is_active(self) -> bool:
        """Whether the clocks have simulated time."""
        return self._ros_time_is_active

    @ros_time_is_active.setter
    def ros_time_is_active(self, enabled: bool) -> None:
        if enabled == self._ros_time_is_active:
            return
        self._ros_time_is_active = enabled
        for clock in self._associated_clocks:
            clock._set_ros_time_is_active(enabled)
        if enabled:
            self._subscribe()
        else:
            self._unsubscribe()

    def attach_node(self, node: NodeEndpoints) -> None:
        """Follow the parameter `use_sim_time` of a node, which is declared if it is not."""
        if not isinstance(node, NodeEndpoints):
            raise TypeError("Node must be of type rclpy.node.Node")
        if self._node_weak_ref is not None:
            self.detach_node()
        self._node_weak_ref = weakref.ref(node)
        if not node.has_parameter(USE_SIM_TIME_NAME):
            node.declare_parameter(USE_SIM_TIME_NAME, False)
        found = node.get_parameter(USE_SIM_TIME_NAME)
        if found.type_ is Parameter.Type.BOOL:
            self.ros_time_is_active = found.value
        elif found.type_ is not Parameter.Type.NOT_SET:
            node.get_logger().error(f"Invalid type for parameter '{USE_SIM_TIME_NAME}' {found.type_!r} should be bool")
        node.add_on_set_parameters_callback(self._on_parameter_event)

    def detach_node(self) -> None:
        """Follow no node."""
        self._unsubscribe()
        self._node_weak_ref = None

    def attach_clock(self, clock: ROSClock) -> None:
        """Set a clock from now on. Raises ValueError for one without ROS time."""
        if not isinstance(clock, ROSClock):
            raise ValueError("Only clocks with type ROS_TIME can be attached.")
        clock.set_ros_time_override(self._last_time_set)
        clock._set_ros_time_is_active(self._ros_time_is_active)
        self._associated_clocks.add(clock)

    def clock_callback(self, msg: ros_types.Clock) -> None:
        """Set all clocks to the time of a message."""
        self._last_time_set = Time.from_msg(msg.clock)
        for clock in self._associated_clocks:
            clock.set_ros_time_override(self._last_time_set)

    def _subscribe(self) -> None:
        node = self._get_node()
        if self._clock_sub is None and node is not None and simulated_ns() is None:
            profile = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
            self._clock_sub = node.create_subscription(ros_types.Clock, CLOCK_TOPIC, self.clock_callback, profile)

    def _unsubscribe(self) -> None:
        node = self._get_node()
        if self._clock_sub is not None and node is not None:
            node.destroy_subscription(self._clock_sub)
        self._clock_sub = None

    def _get_node(self) -> NodeEndpoints | None:
        return None if self._node_weak_ref is None else self._node_weak_ref()

    def _on_parameter_event(self, parameters: list[Parameter]) -> ros_types.SetParametersResult:
        """Follow a change of the parameter, or reject it."""
        for parameter in parameters:
            if parameter.name != USE_SIM_TIME_NAME:
                continue
            if parameter.type_ is not Parameter.Type.BOOL:
                reason = f"{USE_SIM_TIME_NAME} parameter set to something besides a bool"
                if (node := self._get_node()) is not None:
                    node.get_logger().error(reason)
                return ros_types.SetParametersResult(successful=False, reason=reason)
            self.ros_time_is_active = parameter.value
        return ros_types.SetParametersResult(successful=True)
