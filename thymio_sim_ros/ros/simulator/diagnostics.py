"""Publishes `/diagnostics`: pace of the simulation, rejected messages, wrong endpoints, clock conflicts."""

from __future__ import annotations

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.node import Node

from thymio_sim_ros.ros.interface.headers import SECOND_NS, stamp
from thymio_sim_ros.ros.rclpy_ext.connections import Connections
from thymio_sim_ros.ros.rclpy_ext.message_reports import MessageReports
from thymio_sim_ros.ros.simulator.clock_conflict import ClockConflict
from thymio_sim_ros.ros.simulator.tick_scheduler import TickScheduler
from thymio_sim_ros.ros.simulator.world_endpoints import WorldState
from thymio_sim_ros.ros.simulator.world_topics import TOPICS

__all__ = ["Diagnostics"]

SLOW = 0.9
"""Part of the requested real-time factor below which the diagnostics warn."""

TOPIC = "/diagnostics"


class Diagnostics:
    """Collects the statuses of the node and publishes them together."""

    def __init__(
        self, node: Node, messages: MessageReports, connections: Connections, clock_conflict: ClockConflict | None
    ) -> None:
        self._name = node.get_fully_qualified_name().removeprefix("/")
        self._messages, self._connections, self._clock_conflict = messages, connections, clock_conflict
        self._publisher = node.create_publisher(TOPICS[TOPIC].type, TOPIC, TOPICS[TOPIC].profile)

    def publish(self, state: WorldState, scheduler: TickScheduler) -> None:
        """Poll for clock conflicts, then publish all statuses."""
        statuses = [self._pace(state, scheduler), self._messages.status(), self._connections.status()]
        if self._clock_conflict is not None:
            self._clock_conflict.poll()
            statuses.append(self._clock_conflict.status())
        message = DiagnosticArray(status=statuses)
        message.header.stamp = stamp(state.now_ns)
        self._publisher.publish(message)

    def _pace(self, state: WorldState, scheduler: TickScheduler) -> DiagnosticStatus:
        slow = not state.paused and 0 < state.achieved < SLOW * state.real_time_factor
        return DiagnosticStatus(
            level=DiagnosticStatus.WARN if slow else DiagnosticStatus.OK,
            name=f"{self._name}: pace",
            hardware_id="thymio_sim_ros",
            message="paused" if state.paused else "slower than requested" if slow else "running",
            values=[
                KeyValue(key="real-time factor wanted", value=f"{state.real_time_factor:g}"),
                KeyValue(key="real-time factor achieved", value=f"{state.achieved:.3f}"),
                KeyValue(key="simulated seconds", value=f"{state.now_ns / SECOND_NS:.2f}"),
                KeyValue(key="ticks late", value=str(scheduler.late_ticks)),
                KeyValue(key="ticks dropped", value=str(scheduler.dropped_ticks)),
                KeyValue(key="robots", value=str(len(state.robots))),
            ],
        )
