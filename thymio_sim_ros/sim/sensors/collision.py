"""Whether the robot touches anything but the floor, reported at the start and on change."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thymio_sim_ros.sim.model.readings import CollisionReading
from thymio_sim_ros.sim.physics import Contact
from thymio_sim_ros.sim.plugin_api.view import BatchSensorView, SensorView
from thymio_sim_ros.sim.sensors import Sensor

__all__ = ["SENSOR"]

_UNKNOWN = -1
"""Neither true nor false: nothing was reported yet."""


def _measure(view: SensorView) -> CollisionReading | None:
    is_touching = bool(view.contacts)
    if is_touching == view.memory.get("is_touching", _UNKNOWN):
        return None
    view.memory["is_touching"] = is_touching
    return CollisionReading(view.now_ns, (), is_touching)


def _measure_all(batch: BatchSensorView) -> Sequence[CollisionReading | None]:
    reported, are_touching = batch.column_state.column("is_touching", _UNKNOWN), np.zeros(len(batch), dtype=int)
    are_touching[list(batch.contacts)] = True
    readings: list[CollisionReading | None] = [None] * len(batch)
    for robot in np.flatnonzero(reported != are_touching).tolist():
        readings[robot] = CollisionReading(batch.now_ns, (), bool(are_touching[robot]))
    reported[:] = are_touching
    return readings


SENSOR = Sensor(
    name="collision",
    period_ns=50_000_000,
    measure=_measure,
    measure_all=_measure_all,
    phase_ns=10_000_000,
    wakes_on=(Contact,),
)
