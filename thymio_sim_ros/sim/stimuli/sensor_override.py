"""Readings that replace those of proximity and ground sensors, as when an operator holds a hand over them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from thymio_sim_ros.sim.commands import SetGround, SetProximity
from thymio_sim_ros.sim.stimuli import Stimulus

__all__ = ["STIMULUS", "SensorOverrideState", "overridden"]


@dataclass(slots=True)
class SensorOverrideState:
    """Counts of the seven proximity and the two ground sensors; empty, or -1 for a sensor that is not overridden."""

    proximity: tuple[int, ...] = ()
    ground: tuple[int, ...] = ()


def overridden(measured: Sequence[int], override: Sequence[int]) -> Sequence[int]:
    """The counts of sensors: the override where there is one, otherwise the measured value.

    `override` is empty or has one count per sensor.
    """
    if not override:
        return measured
    return [own if other < 0 else other for own, other in zip(measured, override, strict=True)]


def _apply(state: SensorOverrideState, command: SetProximity | SetGround, _now_ns: int) -> None:
    counts = command.counts if max(command.counts) >= 0 else ()
    if isinstance(command, SetProximity):
        state.proximity = counts
    else:
        state.ground = counts


STIMULUS = Stimulus(name="sensor_override", accepts=(SetProximity, SetGround), begin=SensorOverrideState, apply=_apply)
