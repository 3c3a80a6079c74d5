"""Bindings between plug-ins and the memory of a machine, derived from the declarations of sensors and actuators.

A sensor is declared once, in `sim/sensors`; its variables, addresses, events and topic follow from the declaration.
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
    """A variable: its address, the index of its first word in the reading, and the event of its changes, if any."""

    address: int
    size: int
    begin: int = 0
    edge: int | None = None


class Run(NamedTuple):
    """A range of addresses and the range of words that belongs there; the ends are exclusive."""

    address: int
    address_end: int
    begin: int
    end: int


@dataclass(frozen=True, slots=True)
class SensorBinding:
    """The variables that hold parts of a reading of `size` words, and the local event that it causes.

    `runs` are the slots, with adjacent ones joined; `edges` are the slots whose changes cause an event.
    `above` is the address of a threshold: it must be exceeded by the first word, and not be 0, to cause `event`.
    """

    slots: tuple[Slot, ...]
    runs: tuple[Run, ...]
    edges: tuple[Slot, ...]
    size: int
    event: int | None
    above: int | None = None


@dataclass(frozen=True, slots=True)
class OutputBinding:
    """Variables that a program writes, and the command made from their words; `runs` are the slots, joined."""

    slots: tuple[Slot, ...]
    runs: tuple[Run, ...]
    command: Callable[[Sequence[int]], Command]


@cache
def sensors(layout: str = THYMIO) -> dict[str, SensorBinding]:
    """Bindings of all sensors with Aseba variables or an event, by name, without variables that the layout lacks."""
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
    """Names of the sensors with Aseba variables or an event, in the order in which they measure."""
    return tuple(sensors())


@cache
def outputs(layout: str = THYMIO) -> tuple[OutputBinding, ...]:
    """Bindings of all groups of variables that make a command; groups that the layout lacks are skipped."""
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
    """Native functions declared by actuators, by name."""
    return {native.name: native for actuator in compatible_plugins()[1] for native in actuator.aseba.natives}


@cache
def at_reset() -> tuple[Command, ...]:
    """Commands for the actuators after a reset of the robot."""
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
