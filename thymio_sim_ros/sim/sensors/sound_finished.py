"""Reports that a sound came to its natural end; not that it was stopped or replaced.

Source: docs/spec/thymio-robot.md section 5.
"""

from __future__ import annotations

from thymio_sim_ros.sim.actuators.loudspeaker import LoudspeakerState
from thymio_sim_ros.sim.model.readings import SoundFinishedReading
from thymio_sim_ros.sim.plugin_api.aseba_binding import AsebaFace
from thymio_sim_ros.sim.plugin_api.view import SensorView
from thymio_sim_ros.sim.sensors import NEVER_NS, Sensor

__all__ = ["SENSOR"]


def _measure(view: SensorView) -> SoundFinishedReading | None:
    finished = view.state(LoudspeakerState).finished
    if finished == view.memory.get("finished", 0):
        return None
    view.memory["finished"] = finished
    return SoundFinishedReading(view.now_ns, ())


SENSOR = Sensor(
    name="sound_finished",
    period_ns=NEVER_NS,
    measure=_measure,
    aseba=AsebaFace(event="sound.finished"),
    wakes_on=(LoudspeakerState,),
)
