"""The present sound of the loudspeaker, reported on change, so that viewers can play or draw it."""

from __future__ import annotations

from thymio_sim_ros.sim.actuators.loudspeaker import ACTUATOR, LoudspeakerState
from thymio_sim_ros.sim.audio.synthesis import SAMPLE_NS
from thymio_sim_ros.sim.model.readings import LoudspeakerReading
from thymio_sim_ros.sim.plugin_api.view import SensorView
from thymio_sim_ros.sim.sensors import NEVER_NS, Sensor

__all__ = ["SENSOR"]


def _measure(view: SensorView) -> LoudspeakerReading | None:
    state = view.state(LoudspeakerState)
    if state.changes == view.memory.get("changes", 0):
        return None
    view.memory["changes"] = state.changes
    note = state.note
    frequency_hz, duration_ns = (note.frequency_hz, note.duration_ns) if note else (0.0, len(state.samples) * SAMPLE_NS)
    return LoudspeakerReading(
        view.now_ns, (), state.began_ns, frequency_hz, duration_ns, state.wave, state.samples, state.shift
    )


SENSOR = Sensor(
    name="loudspeaker", period_ns=NEVER_NS, measure=_measure, wakes_on=(*ACTUATOR.accepts, LoudspeakerState)
)
