"""The microphone, 61 blocks a second of 128 8-bit samples (docs/spec/thymio-robot.md sections 3 and 7.4), no noise.

mic.intensity is the largest minus the smallest sample of a block, 0…255, mic._mean their sum; in silence all samples
are 128. The level is that of the background noise and of all sounds of the world, attenuated by distance
(`sim/audio/propagation.py`), energies added. The event `mic` comes with every block that is louder than mic.threshold,
unless that is 0. Quieter blocks are reported on change and once per second.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from thymio_sim_ros.sim.actuators.microphone import MicrophoneState
from thymio_sim_ros.sim.audio.propagation import FULL_LEVEL, Sound, level_at
from thymio_sim_ros.sim.model.readings import SoundReading
from thymio_sim_ros.sim.model.robot_constants import REFRESH_NS
from thymio_sim_ros.sim.plugin_api.aseba_binding import AsebaFace
from thymio_sim_ros.sim.plugin_api.display import DisplayedValue
from thymio_sim_ros.sim.plugin_api.view import BatchSensorView
from thymio_sim_ros.sim.sensors import Sensor
from thymio_sim_ros.sim.stimuli.environment import EnvironmentState

__all__ = ["BLOCK_NS", "SENSOR", "intensity_at", "report"]

BLOCK_NS = 16_384_000
"""128 samples at 7812.5 Hz (docs/spec/thymio-robot.md section 9)."""

_SILENCE = 128
"""A sample in silence: the middle of 8 bits. Assumption."""


def _prepare(batch: BatchSensorView) -> Callable[[], Sequence[SoundReading | None]]:
    environments, microphones = batch.states(EnvironmentState), batch.states(MicrophoneState)
    robots, memories = batch.robots, batch.memories

    def measure() -> Sequence[SoundReading | None]:
        now_ns, levels = batch.now_ns, [environment.noise_level for environment in environments]
        if sounds := batch.sounds:
            places = zip(levels, robots.x.tolist(), robots.y.tolist(), strict=False)
            levels = [intensity_at(level, sounds, x, y) for level, x, y in places]
        return [
            report(now_ns, level, microphone, memory)
            for level, microphone, memory in zip(levels, microphones, memories, strict=True)
        ]

    return measure


def intensity_at(noise_level: int, sounds: Sequence[Sound], x_m: float, y_m: float) -> int:
    """mic.intensity at a point for a background noise and all sounds of the world."""
    return min(FULL_LEVEL, round(math.hypot(noise_level, level_at(sounds, x_m, y_m))))


def report(now_ns: int, intensity: int, microphone: MicrophoneState, memory: dict[str, int]) -> SoundReading | None:
    """The reading of a block; None if it need not be reported. `memory` has the last report of the robot."""
    is_loud = microphone.is_exceeded(intensity)
    if intensity != memory.get("intensity") or now_ns >= memory["refresh_ns"]:
        memory["intensity"], memory["refresh_ns"] = intensity, now_ns + REFRESH_NS
    elif not is_loud:
        return None
    smallest = _SILENCE - (intensity + 1) // 2
    return SoundReading(now_ns, (intensity, 2 * smallest + intensity), is_loud)


SENSOR = Sensor(
    name="sound",
    period_ns=BLOCK_NS,
    prepare_all=_prepare,
    aseba=AsebaFace(variables=(("mic.intensity", 1), ("mic._mean", 1)), event="mic", above="mic.threshold"),
    label="microphone",
    values=(DisplayedValue("", "%", 100 / FULL_LEVEL, full_scale=FULL_LEVEL),),
)
