"""Whether the robot touches anything but the floor, reported at the start and on change."""

from __future__ import annotations

from thymio_sim_ros.sim.model.readings import CollisionReading
from thymio_sim_ros.sim.physics import Contact
from thymio_sim_ros.sim.plugin_api.view import SensorView
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


SENSOR = Sensor(
    name="collision",
    period_ns=50_000_000,
    measure=_measure,
    phase_ns=10_000_000,
    wakes_on=(Contact,),
)
