"""The five buttons, scanned at 50 Hz; each that changed also raises the event of its own name (section 5)."""

from __future__ import annotations

from thymio_sim_ros.sim.commands import BUTTONS
from thymio_sim_ros.sim.model.readings import ButtonsReading
from thymio_sim_ros.sim.plugin_api.aseba_binding import AsebaFace
from thymio_sim_ros.sim.plugin_api.view import SensorView
from thymio_sim_ros.sim.sensors import Sensor
from thymio_sim_ros.sim.stimuli.buttons import ButtonState

__all__ = ["SENSOR"]


def _measure(view: SensorView) -> ButtonsReading:
    return ButtonsReading(view.now_ns, view.state(ButtonState).words)


SENSOR = Sensor(
    name="buttons",
    period_ns=20_000_000,
    measure=_measure,
    is_stateless=True,
    aseba=AsebaFace(variables=tuple((f"button.{button}", 1) for button in BUTTONS), event="buttons", edge_events=True),
    values=(),
)
