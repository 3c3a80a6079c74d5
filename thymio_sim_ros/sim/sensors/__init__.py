"""Sensors, one file each: how often they measure, what they return, what an Aseba program sees of it.

A module exports SENSOR. `measure` reads a view and returns a reading, or None when there is nothing new. All
sensors that are due in a tick measure in name order, so `ground` comes before `proximity`, whose `prox` event
then finds both stored.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass

from thymio_sim_ros import registry
from thymio_sim_ros.sim.aseba_face import NO_SENSOR_FACE, AsebaFace
from thymio_sim_ros.sim.clock import Schedule
from thymio_sim_ros.sim.readings import Reading
from thymio_sim_ros.sim.view import SensorView

__all__ = ["Sensor", "all_sensors"]


@dataclass(frozen=True, slots=True)
class Sensor:
    """One sensor; it measures every `period_ns`, counted from `phase_ns`."""

    name: str
    period_ns: int
    measure: Callable[[SensorView], Reading | None]
    aseba: AsebaFace = NO_SENSOR_FACE
    phase_ns: int = 0

    @property
    def schedule(self) -> Schedule:
        """When it measures."""
        return Schedule(self.period_ns, self.phase_ns)


def all_sensors() -> tuple[Sensor, ...]:
    """Every sensor of this folder, in name order."""
    return registry.collect(sys.modules[__name__], "SENSOR", Sensor)
