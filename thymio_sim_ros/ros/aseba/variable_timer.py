"""Polls the variables of all robots at the rate of the parameter `watch_rate`."""

from __future__ import annotations

from rclpy.clock import Clock
from rclpy.node import Node

from thymio_sim_ros.ros.aseba.robot_set import RobotSet

__all__ = ["VariableTimer"]


class VariableTimer:
    """A timer whose rate can be changed, which rclpy's cannot."""

    def __init__(self, node: Node, clock: Clock, robots: RobotSet, rate_hz: float) -> None:
        self._node, self._clock, self._robots = node, clock, robots
        self._timer = node.create_timer(1.0 / rate_hz, robots.publish_variables, clock=clock)

    def set_rate(self, rate_hz: float) -> None:
        """Poll at another rate in Hz."""
        self._node.destroy_timer(self._timer)
        self._timer = self._node.create_timer(1.0 / rate_hz, self._robots.publish_variables, clock=self._clock)
