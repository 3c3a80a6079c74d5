"""Whether the robot touches anything but the floor: told when it changes, the first time at the start."""

from __future__ import annotations

from thymio_sim_ros.sim.physics import Contact
from thymio_sim_ros.sim.readings import CollisionReading
from thymio_sim_ros.sim.sensors import Sensor
from thymio_sim_ros.sim.view import SensorView

__all__ = ["SENSOR"]


def _measure(view: SensorView) -> CollisionReading | None:
    is_touching = bool(view.contacts)
    if is_touching == view.memory.get("is_touching"):
        return None
    view.memory["is_touching"] = is_touching
    return CollisionReading(view.now_ns, (), is_touching)


SENSOR = Sensor(name="collision", period_ns=50_000_000, measure=_measure, phase_ns=10_000_000, wakes_on=(Contact,))
