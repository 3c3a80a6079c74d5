"""Tracks which robot topics are published, and when the next of their readings is due.

Until then the simulator may sleep, since no subscriber could see a difference.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import NamedTuple

from thymio_sim_ros.sim.model.clock import NEVER_NS, TICK_NS, next_due_ns
from thymio_sim_ros.sim.sensors import all_sensors

__all__ = ["SubscriberDemand", "TopicDemand"]


class TopicDemand(NamedTuple):
    """The source of a topic: a sensor, the shortest period `every_ns`, and whether it is periodic or event driven."""

    sensor: str
    every_ns: int = 0
    is_periodic: bool = True


class SubscriberDemand:
    """Counts published topics by source. Invariant: `sensors` are the sensors of at least one published topic."""

    def __init__(self, periods_ns: Mapping[str, int] | None = None) -> None:
        """`periods_ns`: periods that override those declared by the sensors."""
        periods_ns = periods_ns or {}
        sensors = [sensor.with_period(periods_ns.get(sensor.name, sensor.period_ns)) for sensor in all_sensors()]
        self._schedule = {sensor.name: (sensor.period_ns, sensor.phase_ns) for sensor in sensors}
        self._counts: Counter[TopicDemand] = Counter()
        self._since_ns, self._due_ns = 0, 0
        self._is_due_always = False
        """Whether every tick has a reading that is published."""
        self.sensors: frozenset[str] = frozenset()

    def add(self, topic: TopicDemand) -> None:
        """Count a topic that is published from now on."""
        self._counts[topic] += 1
        if self._counts[topic] == 1:
            self._change()

    def remove(self, topic: TopicDemand) -> None:
        """Remove a topic that is no longer published."""
        self._counts[topic] -= 1
        if not self._counts[topic]:
            del self._counts[topic]
            self._change()

    def due_ns(self, now_ns: int) -> int:
        """Return the time of the first tick after `now_ns` with a periodic reading to publish; `NEVER_NS` if none."""
        if self._is_due_always:
            return now_ns + TICK_NS
        if not self._since_ns <= now_ns < self._due_ns:
            self._since_ns = now_ns
            self._due_ns = min((self._next_ns(topic, now_ns) for topic in self._counts), default=NEVER_NS)
        return self._due_ns

    def _next_ns(self, topic: TopicDemand, now_ns: int) -> int:
        period_ns, phase_ns = self._schedule[topic.sensor]
        if not topic.is_periodic or period_ns == NEVER_NS:
            return NEVER_NS
        if topic.every_ns:
            now_ns = (now_ns // topic.every_ns + 1) * topic.every_ns - 1
        return next_due_ns(period_ns, phase_ns, now_ns)

    def _change(self) -> None:
        self.sensors = frozenset(topic.sensor for topic in self._counts)
        self._is_due_always = any(
            topic.is_periodic and max(self._schedule[topic.sensor][0], topic.every_ns) <= TICK_NS
            for topic in self._counts
        )
        self._due_ns = 0
