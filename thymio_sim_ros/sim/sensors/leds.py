"""The LEDs, polled 25 times per second, reported at the start and on change."""

from __future__ import annotations

from typing import Any

from thymio_sim_ros.sim.actuators.leds import LedState
from thymio_sim_ros.sim.model.readings import LedReading
from thymio_sim_ros.sim.plugin_api.view import SensorView
from thymio_sim_ros.sim.sensors import Sensor

__all__ = ["SENSOR"]


def _measure(view: SensorView) -> LedReading | None:
    state, memory = view.state(LedState), view.memory
    return None if state.changes == memory.get("changes") else _changed(state, memory, view.now_ns)


def _changed(state: LedState, memory: dict[str, Any], now_ns: int) -> LedReading | None:
    """A reading; None if the levels are those published last."""
    memory["changes"], groups = state.changes, tuple(state.levels.items())
    if groups == memory.get("groups"):
        return None
    memory["groups"] = groups
    return LedReading(now_ns, (), groups)


SENSOR = Sensor(name="leds", period_ns=40_000_000, measure=_measure, phase_ns=10_000_000)
