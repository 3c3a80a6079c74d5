"""The receiver of the remote control: every new RC5 frame, repeated ones left out.

Source: docs/spec/thymio-robot.md section 5.
"""

from __future__ import annotations

from thymio_sim_ros.sim.commands import RemoteKey
from thymio_sim_ros.sim.model.readings import RemoteReading
from thymio_sim_ros.sim.plugin_api.aseba_binding import AsebaFace
from thymio_sim_ros.sim.plugin_api.view import SensorView
from thymio_sim_ros.sim.sensors import NEVER_NS, Sensor
from thymio_sim_ros.sim.stimuli.remote import RemoteState

__all__ = ["SENSOR"]


def _measure(view: SensorView) -> RemoteReading | None:
    state, memory = view.state(RemoteState), view.memory
    if state.frames == memory.get("frames", 0):
        return None
    memory["frames"] = state.frames
    return RemoteReading(view.now_ns, (state.address, state.command))


SENSOR = Sensor(
    name="remote",
    period_ns=NEVER_NS,
    measure=_measure,
    wakes_on=(RemoteKey,),
    aseba=AsebaFace(variables=(("rc5.address", 1), ("rc5.command", 1)), event="rc5"),
    values=(),
)
