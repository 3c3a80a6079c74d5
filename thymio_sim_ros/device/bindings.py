"""Where a sensor's words go and an actuator's commands come from: derived from what the plug-ins declare.

A sensor is declared once, in `sim/sensors`; its variables, addresses, events and topic follow from there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

from thymio_sim_ros.device.layout import THYMIO, compatible_plugins, target
from thymio_sim_ros.sim.commands import Command
from thymio_sim_ros.sim.plugin_api.aseba_binding import Native


@dataclass(frozen=True, slots=True)
class Slot:
    """A variable: where it lies, its words' place in the reading, and the event that a change of it raises, if any."""

    address: int
    size: int
    begin: int = 0
    edge: int | None = None


class Run(NamedTuple):
    """A part of the memory, and of the words that belong there; each ends before its `end`."""

    address: int
    address_end: int
    begin: int
    end: int


@dataclass(frozen=True, slots=True)
class SensorBinding:
    """The variables that hold parts of a reading of `size` words, and the local event it raises.

    `runs` are the same places joined where they touch, `edges` those of them that raise an event of their own.
    `above`: address of the variable that the first word must exceed for the event, and that must not be 0.
    """

    slots: tuple[Slot, ...]
    runs: tuple[Run, ...]
    edges: tuple[Slot, ...]
    size: int
    event: int | None
    above: int | None = None


@dataclass(frozen=True, slots=True)
class OutputBinding:
    """Variables that a program writes and the command they make together; `runs` as in `SensorBinding`."""

    slots: tuple[Slot, ...]
    runs: tuple[Run, ...]
    command: Callable[[Sequence[int]], Command]


@cache
def sensors(layout: str = THYMIO) -> dict[str, SensorBinding]:
    """Every sensor that Aseba sees, by name; variables that the layout lacks are left out."""
    addresses = target(layout).addresses
    found = {}
    for sensor in compatible_plugins()[0]:
        if not (sensor.aseba.variables or sensor.aseba.event):
            continue
        slots = tuple(_slots(sensor.aseba.variables, layout, has_edges=sensor.aseba.edge_events))
        found[sensor.name] = SensorBinding(
            slots,
            _runs(slots),
            tuple(slot for slot in slots if slot.edge is not None),
            sensor.aseba.size,
            None if sensor.aseba.event is None else _event(sensor.aseba.event, layout),
            addresses[sensor.aseba.above][0] if sensor.aseba.above in addresses else None,
        )
    return found


def sensor_names() -> tuple[str, ...]:
    """Names of the sensors that Aseba sees, in the order in which they measure."""
    return tuple(sensors())


@cache
def outputs(layout: str = THYMIO) -> tuple[OutputBinding, ...]:
    """Every group of variables that makes a command; groups that the layout lacks are left out."""
    addresses = target(layout).addresses
    found = []
    for actuator in compatible_plugins()[1]:
        for output in actuator.aseba.outputs:
            if all(name in addresses for name, _ in output.variables):
                slots = tuple(_slots(output.variables, layout))
                found.append(OutputBinding(slots, _runs(slots), output.command))
    return tuple(found)


@cache
def natives() -> dict[str, Native]:
    """Every native function that reaches an actuator, by name."""
    return {native.name: native for actuator in compatible_plugins()[1] for native in actuator.aseba.natives}


@cache
def at_reset() -> tuple[Command, ...]:
    """What a reset of the robot tells its actuators."""
    return tuple(command for actuator in compatible_plugins()[1] for command in actuator.aseba.at_reset)


def _slots(variables: Sequence[tuple[str, int]], layout: str, *, has_edges: bool = False) -> Iterator[Slot]:
    addresses, begin = target(layout).addresses, 0
    for name, size in variables:
        if name in addresses:
            yield Slot(addresses[name][0], size, begin, _event(name, layout) if has_edges else None)
        begin += size


def _runs(slots: Sequence[Slot]) -> tuple[Run, ...]:
    runs: list[Run] = []
    for slot in slots:
        run = Run(slot.address, slot.address + slot.size, slot.begin, slot.begin + slot.size)
        if runs and (runs[-1].address_end, runs[-1].end) == (run.address, run.begin):
            run = Run(runs[-1].address, run.address_end, runs[-1].begin, run.end)
            runs.pop()
        runs.append(run)
    return tuple(runs)


def _event(name: str, layout: str) -> int:
    """Index of a local event."""
    return 0xFFFE - target(layout).local_event_number(name)
