"""Where a sensor's words go and an actuator's commands come from: derived from what the plug-ins declare.

A sensor is declared once, in `sim/sensors`; its variables, addresses, events and topic follow from there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache

from thymio_sim_ros.device.layout import target
from thymio_sim_ros.sim.actuators import all_actuators
from thymio_sim_ros.sim.aseba_face import Native
from thymio_sim_ros.sim.commands import Command
from thymio_sim_ros.sim.sensors import all_sensors


@dataclass(frozen=True, slots=True)
class Slot:
    """A variable: where it lies, and the local event that a change of it raises, if any."""

    address: int
    size: int
    edge: int | None


@dataclass(frozen=True, slots=True)
class SensorBinding:
    """The variables that hold a reading's words in order, and the local event it raises.

    `above`: address of the variable that the first word must exceed for the event, and that must not be 0.
    """

    slots: tuple[Slot, ...]
    event: int | None
    above: int | None = None

    @property
    def size(self) -> int:
        """Words of a reading."""
        return sum(slot.size for slot in self.slots)


@dataclass(frozen=True, slots=True)
class OutputBinding:
    """Variables that a program writes and the command they make together."""

    slots: tuple[Slot, ...]
    command: Callable[[Sequence[int]], Command]


@cache
def sensors() -> dict[str, SensorBinding]:
    """Every sensor that Aseba sees, by name."""
    return {
        sensor.name: SensorBinding(
            tuple(_slot(name, edge=sensor.aseba.edge_events) for name, _ in sensor.aseba.variables),
            None if sensor.aseba.event is None else _event(sensor.aseba.event),
            None if sensor.aseba.above is None else target().addresses[sensor.aseba.above][0],
        )
        for sensor in all_sensors()
        if sensor.aseba.variables or sensor.aseba.event
    }


def sensor_names() -> tuple[str, ...]:
    """Names of the sensors that Aseba sees, in the order in which they measure."""
    return tuple(sensors())


@cache
def outputs() -> tuple[OutputBinding, ...]:
    """Every group of variables that makes a command."""
    return tuple(
        OutputBinding(tuple(_slot(name, edge=False) for name, _ in output.variables), output.command)
        for actuator in all_actuators()
        for output in actuator.aseba.outputs
    )


@cache
def natives() -> dict[str, Native]:
    """Every native function that reaches an actuator, by name."""
    return {native.name: native for actuator in all_actuators() for native in actuator.aseba.natives}


@cache
def at_reset() -> tuple[Command, ...]:
    """What a reset of the robot tells its actuators."""
    return tuple(command for actuator in all_actuators() for command in actuator.aseba.at_reset)


def _slot(name: str, *, edge: bool) -> Slot:
    address, size = target().addresses[name]
    return Slot(address, size, _event(name) if edge else None)


def _event(name: str) -> int:
    """Index of a local event."""
    return 0xFFFE - target().local_event_number(name)
