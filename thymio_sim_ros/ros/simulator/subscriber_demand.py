"""Which topics of robots somebody hears, and when the next of their readings is due.

Until then the simulator may sleep: nothing that it would do earlier could be seen.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import NamedTuple

from thymio_sim_ros.sim.model.clock import NEVER_NS, TICK_NS, next_due_ns
from thymio_sim_ros.sim.sensors import all_sensors

__all__ = ["SubscriberDemand", "TopicDemand"]


class TopicDemand(NamedTuple):
    """A topic by what makes it: a sensor, not more often than `every_ns`; regular, or when something happens."""

    sensor: str
    every_ns: int = 0
    is_periodic: bool = True


class SubscriberDemand:
    """Counts of the topics that are sent. Invariant: `sensors` are those of at least one of them."""

    def __init__(self, periods_ns: Mapping[str, int] | None = None) -> None:
        """`periods_ns`: of sensors that do not measure as often as they say themselves."""
        periods_ns = periods_ns or {}
        sensors = [sensor.every(periods_ns.get(sensor.name, sensor.period_ns)) for sensor in all_sensors()]
        self._schedule = {sensor.name: (sensor.period_ns, sensor.phase_ns) for sensor in sensors}
        self._counts: Counter[TopicDemand] = Counter()
        self._since_ns, self._due_ns = 0, 0
        self._is_due_always = False
        """Whether each tick gives a reading that is sent."""
        self.sensors: frozenset[str] = frozenset()

    def add(self, topic: TopicDemand) -> None:
        """A topic is sent from now on."""
        self._counts[topic] += 1
        if self._counts[topic] == 1:
            self._change()

    def remove(self, topic: TopicDemand) -> None:
        """It is not sent any more."""
        self._counts[topic] -= 1
        if not self._counts[topic]:
            del self._counts[topic]
            self._change()

    def due_ns(self, now_ns: int) -> int:
        """The first tick after now that gives a regular reading that is sent; `NEVER_NS` without any."""
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
