"""The microphone, 61 blocks a second of 128 8-bit samples (docs/spec/thymio-robot.md sections 3 and 7.4), no noise.

mic.intensity is the largest minus the smallest sample of a block, 0…255, mic._mean their sum; in silence all samples
are 128. The level is that of the background noise and of all sounds of the world, attenuated by distance
(`sim/audio/propagation.py`), energies added. The event `mic` comes with every block that is louder than mic.threshold,
unless that is 0. Quieter blocks are reported on change and once per second.
"""

from __future__ import annotations

import math

from thymio_sim_ros.sim.actuators.microphone import MicrophoneState
from thymio_sim_ros.sim.audio.propagation import FULL_LEVEL, level_at
from thymio_sim_ros.sim.model.readings import SoundReading
from thymio_sim_ros.sim.plugin_api.aseba_binding import AsebaFace
from thymio_sim_ros.sim.plugin_api.display import DisplayedValue
from thymio_sim_ros.sim.plugin_api.view import SensorView
from thymio_sim_ros.sim.sensors import Sensor
from thymio_sim_ros.sim.sensors._publish_on_change import should_publish
from thymio_sim_ros.sim.stimuli.environment import EnvironmentState

__all__ = ["BLOCK_NS", "SENSOR"]

BLOCK_NS = 16_384_000
"""128 samples at 7812.5 Hz (docs/spec/thymio-robot.md section 9)."""

_SILENCE = 128
"""A sample in silence: the middle of 8 bits. Assumption."""


def _measure(view: SensorView) -> SoundReading | None:
    intensity = view.state(EnvironmentState).noise_level
    if sounds := view.sounds:
        intensity = round(math.hypot(intensity, level_at(sounds, view.pose.x_m, view.pose.y_m)))
    intensity = min(FULL_LEVEL, intensity)
    is_loud = view.state(MicrophoneState).is_exceeded(intensity)
    if not should_publish(view, intensity) and not is_loud:
        return None
    return _reading(view.now_ns, intensity, is_loud=is_loud)


def _reading(now_ns: int, intensity: int, *, is_loud: bool) -> SoundReading:
    smallest = _SILENCE - (intensity + 1) // 2
    return SoundReading(now_ns, (intensity, 2 * smallest + intensity), is_loud)


SENSOR = Sensor(
    name="sound",
    period_ns=BLOCK_NS,
    measure=_measure,
    aseba=AsebaFace(variables=(("mic.intensity", 1), ("mic._mean", 1)), event="mic", above="mic.threshold"),
    label="microphone",
    values=(DisplayedValue("", "%", 100 / FULL_LEVEL, full_scale=FULL_LEVEL),),
)
