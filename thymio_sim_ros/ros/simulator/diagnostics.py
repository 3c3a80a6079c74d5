"""Publishes `/diagnostics`: pace of the simulation, rejected messages, wrong endpoints, clock conflicts."""

from __future__ import annotations

import time

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.node import Node

from thymio_sim_ros.ros.interface.headers import SECOND_NS, stamp
from thymio_sim_ros.ros.rclpy_ext.connections import Connections
from thymio_sim_ros.ros.simulator.clock_conflict import ClockConflict
from thymio_sim_ros.ros.simulator.tick_scheduler import TickScheduler
from thymio_sim_ros.ros.simulator.world_endpoints import WorldState
from thymio_sim_ros.ros.simulator.world_topics import TOPICS

__all__ = ["Diagnostics", "MessageReports"]

SLOW = 0.9
"""Part of the requested real-time factor below which the diagnostics warn."""

TOPIC = "/diagnostics"


RECENT_S = 10.0
"""How long a report about a message counts as the present state."""


class MessageReports:
    """What is wrong with messages to robots and world: their numbers since the start, and the last reports by topic."""

    def __init__(self) -> None:
        self.rejected = 0
        self.clamped = 0
        self._faults: dict[str, tuple[str, float]] = {}
        self._limits: dict[str, tuple[str, float]] = {}

    def add_rejected(self, topic: str, text: str) -> None:
        """Report a rejected message."""
        self.rejected += 1
        self.add_suspect(topic, text)

    def add_suspect(self, topic: str, text: str) -> None:
        """Report a message that was executed, but is surely a mistake."""
        self._faults[topic] = f"{topic} {text}", time.monotonic()

    def add_clamped(self, topic: str, text: str) -> None:
        """Report a clamped message; that is no fault: programs use large numbers for full speed."""
        self.clamped += 1
        self._limits[topic] = f"{topic} {text}", time.monotonic()

    @property
    def faults(self) -> tuple[str, ...]:
        """What is wrong with recent messages, a sentence for each topic."""
        return _recent(self._faults)

    def status(self, name: str) -> DiagnosticStatus:
        """Return the entry for `/diagnostics`: WARN while messages are rejected."""
        faults, limits = self.faults, _recent(self._limits)
        counts = (("rejected", self.rejected), ("clamped", self.clamped))
        return DiagnosticStatus(
            level=DiagnosticStatus.WARN if faults else DiagnosticStatus.OK,
            name=f"{name}: messages",
            hardware_id="thymio_sim_ros",
            message=faults[0] if faults else "no message was rejected lately",
            values=[
                *(KeyValue(key=key, value=str(count)) for key, count in counts),
                *(KeyValue(key=text.partition(" ")[0], value=text) for text in (*faults, *limits)),
            ],
        )


def _recent(reports: dict[str, tuple[str, float]]) -> tuple[str, ...]:
    since_s = time.monotonic() - RECENT_S
    return tuple(text for text, when_s in reports.values() if when_s >= since_s)


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
        statuses = [self._pace(state, scheduler), self._messages.status(self._name), self._connections.status()]
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
