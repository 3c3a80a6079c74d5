"""The pen and its trail, polled 5 times per second and reported on change. Aseba programs do not see it."""

from __future__ import annotations

from thymio_sim_ros.sim.actuators.pen import PenState
from thymio_sim_ros.sim.model.readings import PenReading
from thymio_sim_ros.sim.plugin_api.view import SensorView
from thymio_sim_ros.sim.sensors import Sensor

__all__ = ["SENSOR"]


def _measure(view: SensorView) -> PenReading | None:
    state = view.state(PenState)
    if state.changes == view.memory.get("changes", 0):
        return None
    view.memory["changes"] = state.changes
    return PenReading(view.now_ns, (), state.down, state.color, state.width_m, state.erase, state.strokes)


SENSOR = Sensor(name="pen", period_ns=200_000_000, measure=_measure)
