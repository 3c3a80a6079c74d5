"""Publishes `/diagnostics` of the runtime: the status of each robot, rejected messages, wrong endpoints."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Protocol

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.node import Node

from thymio_sim_ros.ros.interface import qos
from thymio_sim_ros.ros.rclpy_ext.connections import Connections
from thymio_sim_ros.ros.rclpy_ext.message_reports import MessageReports

__all__ = ["DiagnosedRobot", "RuntimeDiagnostics"]


class DiagnosedRobot(Protocol):
    """A robot with a status."""

    @property
    def status_message(self) -> DiagnosticStatus:
        """The status that was published last."""

    def observe_load(self) -> None:
        """Report whether the program exceeded the capacity since the last call."""


class RuntimeDiagnostics:
    """The publisher of `/diagnostics`; costs little without subscribers."""

    def __init__(self, node: Node, now: Callable[[], Time]) -> None:
        """`now` returns the time with which messages are stamped."""
        self._now = now
        self._publisher = node.create_publisher(DiagnosticArray, "/diagnostics", qos.SENSOR)
        self._connections = Connections(node)
        self.messages = MessageReports(node)
        """Takes what is wrong with messages, such as events that no program declares."""

    def publish_all(self, robots: Sequence[DiagnosedRobot]) -> None:
        """Observe the load of all robots, poll for endpoints that are not connected and publish all statuses."""
        for robot in robots:
            robot.observe_load()
        self._connections.poll()
        self._publish([*(robot.status_message for robot in robots), self.messages.status(), self._connections.status()])

    def publish_changed(self, robot: DiagnosedRobot) -> None:
        """Publish the status of one robot, which has changed."""
        self._publish([robot.status_message])

    def _publish(self, statuses: Iterable[DiagnosticStatus]) -> None:
        if self._publisher.get_subscription_count():
            message = DiagnosticArray(status=list(statuses))
            message.header.stamp = self._now()
            self._publisher.publish(message)
