"""What the lights show, looked at 25 times a second and told when it changed; the first time at the start."""

from __future__ import annotations

from thymio_sim_ros.sim.actuators.leds import LedState
from thymio_sim_ros.sim.readings import LedReading
from thymio_sim_ros.sim.sensors import Sensor
from thymio_sim_ros.sim.view import SensorView

__all__ = ["SENSOR"]


def _measure(view: SensorView) -> LedReading | None:
    groups = tuple(view.state(LedState).levels.items())
    if groups == view.memory.get("groups"):
        return None
    view.memory["groups"] = groups
    return LedReading(view.now_ns, (), groups)


SENSOR = Sensor(name="leds", period_ns=40_000_000, measure=_measure, phase_ns=10_000_000)
