"""Sensors, one file each: how often they measure, what they return, what an Aseba program sees of it.

A module exports SENSOR. `measure` reads a view and returns a reading, or None when there is nothing new. All
sensors that are due in a tick measure in name order, so `ground` comes before `proximity`, whose `prox` event
then finds both stored. A sensor of rare things measures every `NEVER_NS` and is woken by what it `wakes_on`.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from thymio_sim_ros import registry
from thymio_sim_ros.sim.model.clock import NEVER_NS
from thymio_sim_ros.sim.model.readings import Reading
from thymio_sim_ros.sim.plugin_api.aseba_binding import NO_SENSOR_FACE, AsebaFace
from thymio_sim_ros.sim.plugin_api.plugin_isolation import quiet_sensor
from thymio_sim_ros.sim.plugin_api.view import GroupView, SensorView

__all__ = ["NEVER_NS", "Sensor", "all_sensors"]


@dataclass(frozen=True, slots=True)
class Sensor:
    """One sensor; it measures every `period_ns`, counted from `phase_ns`.

    A tick in which its robot got a command of a type in `wakes_on`, or, with `Contact` in it, began to touch something,
    wakes it: then it measures too, or, if it has `feel`, only takes note of what happened. `measure_all`, if there is
    one, gives in one go what `measure` gives one by one.
    """

    name: str
    period_ns: int
    measure: Callable[[SensorView], Reading | None]
    aseba: AsebaFace = NO_SENSOR_FACE
    phase_ns: int = 0
    wakes_on: tuple[type[Any], ...] = ()
    measure_all: Callable[[GroupView], Sequence[Reading | None]] | None = None
    feel: Callable[[SensorView], None] | None = None

    def every(self, period_ns: int) -> Sensor:
        """The same, measuring so often; with another period than its own, from 0 on like all others."""
        return self if period_ns == self.period_ns else replace(self, period_ns=period_ns, phase_ns=0)


def all_sensors() -> tuple[Sensor, ...]:
    """Every sensor of this folder and of other packages, in name order."""
    return registry.collect(sys.modules[__name__], "SENSOR", Sensor, guard=_guarded)


def _guarded(sensor: Sensor) -> Sensor:
    """One of another package: its errors do not stop the world."""
    feel = None if sensor.feel is None else quiet_sensor(sensor.name, sensor.feel)
    return replace(sensor, measure=quiet_sensor(sensor.name, sensor.measure), measure_all=None, feel=feel)
