"""A knock: a contact that begins faster than 2 cm/s, or the operator's hand (thymio-robot.md section 7.3).

acc._tap becomes 1; a program clears it.
"""

from __future__ import annotations

from thymio_sim_ros.sim.actuators.hand import HandState
from thymio_sim_ros.sim.aseba_face import AsebaFace
from thymio_sim_ros.sim.commands import Tap
from thymio_sim_ros.sim.physics import Contact
from thymio_sim_ros.sim.readings import TapReading
from thymio_sim_ros.sim.sensors import NEVER_NS, Sensor
from thymio_sim_ros.sim.thymio2 import TAP_SPEED_M_S
from thymio_sim_ros.sim.view import SensorView

__all__ = ["SENSOR"]


def _measure(view: SensorView) -> TapReading | None:
    taps = view.state(HandState).taps
    is_knocked = taps != view.memory.get("taps", 0)
    view.memory["taps"] = taps
    if is_knocked or any(contact.is_new and contact.speed_m_s > TAP_SPEED_M_S for contact in view.contacts):
        return TapReading(view.now_ns, (1,))
    return None


SENSOR = Sensor(
    name="tap",
    period_ns=NEVER_NS,
    measure=_measure,
    wakes_on=(Tap, Contact),
    aseba=AsebaFace(variables=(("acc._tap", 1),), event="tap"),
)
