"""Taps: a contact that begins faster than 2 cm/s, or a tap by an operator (docs/spec/thymio-robot.md section 7.3).

The landing after a fall is a tap, too; it is detected at the rate of the accelerometer. acc._tap becomes 1; a program
clears it.
"""

from __future__ import annotations

from thymio_sim_ros.sim.commands import Tap
from thymio_sim_ros.sim.model.readings import TapReading
from thymio_sim_ros.sim.model.robot_constants import TAP_SPEED_M_S
from thymio_sim_ros.sim.physics import Contact
from thymio_sim_ros.sim.plugin_api.aseba_binding import AsebaFace
from thymio_sim_ros.sim.plugin_api.view import SensorView
from thymio_sim_ros.sim.sensors import Sensor
from thymio_sim_ros.sim.stimuli.handling import HandlingState

__all__ = ["SENSOR"]


def _measure(view: SensorView) -> TapReading | None:
    memory, taps, is_falling = view.memory, view.state(HandlingState).taps, view.is_falling
    has_landed = memory.get("is_falling", False) and not is_falling and not view.is_standing
    is_knocked = taps != memory.get("taps", 0)
    memory["taps"], memory["is_falling"] = taps, is_falling
    if has_landed or is_knocked or any(_is_knock(contact) for contact in view.contacts):
        return TapReading(view.now_ns, (1,))
    return None


def _is_knock(contact: Contact) -> bool:
    return contact.is_new and contact.speed_m_s > TAP_SPEED_M_S


SENSOR = Sensor(
    name="tap",
    period_ns=62_500_000,
    measure=_measure,
    wakes_on=(Tap, Contact),
    aseba=AsebaFace(variables=(("acc._tap", 1),), event="tap"),
    values=(),
)
