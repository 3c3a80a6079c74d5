"""Sensors, one module each: how often a sensor measures, what it returns, and what an Aseba program sees.

A module exports SENSOR. All sensors that are due in a tick measure in name order: `ground` therefore measures before
`proximity`, and a handler of the event `prox` finds both readings. A sensor of rare events has the period `NEVER_NS`
and is woken by the types in `wakes_on`.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from thymio_sim_ros.files import registry
from thymio_sim_ros.sim.model.clock import NEVER_NS
from thymio_sim_ros.sim.model.lidar import LIDAR, Lidar
from thymio_sim_ros.sim.model.readings import Reading
from thymio_sim_ros.sim.plugin_api.aseba_binding import NO_SENSOR_FACE, AsebaFace
from thymio_sim_ros.sim.plugin_api.display import DisplayedValue, Label
from thymio_sim_ros.sim.plugin_api.plugin_isolation import guarded_sensor
from thymio_sim_ros.sim.plugin_api.view import BatchSensorView, SensorView

__all__ = ["NEVER_NS", "Sensor", "all_sensors", "chosen_sensors"]


@dataclass(frozen=True, slots=True)
class Sensor:
    """One sensor.

    Args:
        name: Name of the sensor, unique among sensors; it also seeds the noise.
        period_ns: Period of the measurement in simulated time; NEVER_NS for a sensor that only measures when woken.
        measure: Returns the reading of one robot, or None if there is nothing new to report.
        aseba: The variables and the event by which Aseba programs see the reading.
        phase_ns: Time of the first measurement, before the period applies.
        wakes_on: Types of commands that wake the sensor in the tick in which its robot gets one; `Contact` wakes it
            when a contact begins. A woken sensor measures in that tick, unless it has `on_wake`.
        prepare_all: Instead of `measure`: called once for all robots, returns the function that returns the readings of
            all of them, in order. Called again when robots are added or removed. Such a sensor is not woken to measure.
        is_stateless: Whether a measurement depends on the present alone, not on memory: one that is left out then makes
            no difference to later ones, and it is left out when its reading is not wanted.
        is_add_on: Whether a robot has it only in a world with that option (`World`), such as the lidar.
        on_wake: Called instead of `measure` when the sensor is woken; it usually writes to `view.memory`.
        label: Heading of its values in viewers; its name if empty.
        values: The rows that viewers show, for the words of a reading in order; None for a row for each variable,
            empty for none, as for sensors whose rows the page arranges itself.

    Raises ValueError if `values` show more words than a reading has, or unless there is either `measure` or
    `prepare_all`.
    """

    name: str
    period_ns: int
    measure: Callable[[SensorView], Reading | None] | None = None
    aseba: AsebaFace = NO_SENSOR_FACE
    phase_ns: int = 0
    wakes_on: tuple[type[Any], ...] = ()
    prepare_all: Callable[[BatchSensorView], Callable[[], Sequence[Reading | None]]] | None = None
    is_stateless: bool = False
    is_add_on: bool = False
    on_wake: Callable[[SensorView], None] | None = None
    label: Label = field(default="", hash=False)
    values: tuple[DisplayedValue, ...] | None = field(default=None, hash=False)

    def __post_init__(self) -> None:
        if (self.measure is None) == (self.prepare_all is None):
            raise ValueError(f"sensor {self.name}: expected either measure or prepare_all")
        if self.prepare_all is not None and self.wakes_on and self.on_wake is None:
            raise ValueError(f"sensor {self.name}: expected on_wake with wakes_on and prepare_all")
        shown = sum(value.words for value in self.displayed)
        if shown > self.aseba.size:
            raise ValueError(f"sensor {self.name}: values show {shown} words, expected at most {self.aseba.size}")

    @property
    def displayed(self) -> tuple[DisplayedValue, ...]:
        """The rows that viewers show."""
        if self.values is not None:
            return self.values
        return tuple(DisplayedValue(name, words=size) for name, size in self.aseba.variables)

    def with_period(self, period_ns: int) -> Sensor:
        """This sensor with another period in ns; its phase is 0 unless the period is its own."""
        return self if period_ns == self.period_ns else replace(self, period_ns=period_ns, phase_ns=0)


def all_sensors() -> tuple[Sensor, ...]:
    """All sensors, of this package and of other packages, in name order."""
    return registry.collect(sys.modules[__name__], "SENSOR", Sensor, check=_check, guard=_guarded)


def chosen_sensors(lidar: Lidar | None, periods_ns: Mapping[str, int] | None) -> tuple[Sensor, ...]:
    """The sensors of robots with these add-ons that measure, with their periods.

    Args:
        lidar: The lidar, None for robots without one; it measures also if it is not among `periods_ns`.
        periods_ns: The sensors that measure, and their periods; None: all, with their own periods.

    Raises:
        ValueError: A name is unknown, or a period is not above 0.
    """
    add_ons = {} if lidar is None else {LIDAR: lidar.period_ns}
    present = [sensor for sensor in all_sensors() if not sensor.is_add_on or sensor.name in add_ons]
    own_ns = {sensor.name: sensor.period_ns for sensor in present} | add_ons
    chosen_ns = own_ns if periods_ns is None else {**add_ons, **periods_ns}
    for name, period_ns in chosen_ns.items():
        if name not in own_ns:
            raise ValueError(f"sensor: found {name!r}, expected one of {', '.join(own_ns)}")
        if period_ns <= 0:
            raise ValueError(f"period of {name!r}: found {period_ns} ns, expected a number above 0")
    return tuple(sensor.with_period(chosen_ns[sensor.name]) for sensor in present if sensor.name in chosen_ns)


def _check(sensor: Sensor) -> None:
    """Raise ValueError for a sensor of another package with `prepare_all`, whose errors would stop the world."""
    if sensor.prepare_all is not None:
        raise ValueError(f"sensor {sensor.name}: found prepare_all, expected measure in a package other than this")


def _guarded(sensor: Sensor) -> Sensor:
    """A sensor of another package, guarded so that its errors do not stop the world."""
    assert sensor.measure is not None  # see `_check`
    on_wake = None if sensor.on_wake is None else guarded_sensor(sensor.name, sensor.on_wake)
    return replace(sensor, measure=guarded_sensor(sensor.name, sensor.measure), on_wake=on_wake)
