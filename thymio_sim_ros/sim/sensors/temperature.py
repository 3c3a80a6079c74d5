"""Temperature, once a second: what the operator sets, in tenths of a degree, no noise.

Source: docs/spec/thymio-robot.md section 7.4.
"""

from __future__ import annotations

from thymio_sim_ros.sim.model import units
from thymio_sim_ros.sim.model.readings import TemperatureReading
from thymio_sim_ros.sim.plugin_api.aseba_binding import AsebaFace
from thymio_sim_ros.sim.plugin_api.display import DisplayedValue
from thymio_sim_ros.sim.plugin_api.view import SensorView
from thymio_sim_ros.sim.sensors import Sensor
from thymio_sim_ros.sim.stimuli.environment import EnvironmentState

__all__ = ["SENSOR"]


def _measure(view: SensorView) -> TemperatureReading:
    celsius = view.state(EnvironmentState).temperature_c
    return TemperatureReading(view.now_ns, (units.celsius_to_units(celsius),), celsius)


SENSOR = Sensor(
    name="temperature",
    period_ns=1_000_000_000,
    phase_ns=10_000_000,
    measure=_measure,
    is_stateless=True,
    aseba=AsebaFace(variables=(("temperature", 1),), event="temperature"),
    values=(DisplayedValue("", "°C", 0.1, digits=1, full_scale=500),),
)
