"""The mixed sound of all loudspeakers of a run as a file: `thymio-sim runner --sound FILE.wav`."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from aseba_vm.cli.output import replacing
from thymio_sim_ros.device.firmware import wav
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.sim.audio.mixer import SoundStream, mixed
from thymio_sim_ros.sim.audio.synthesis import SAMPLE_NS
from thymio_sim_ros.sim.model.readings import LoudspeakerReading
from thymio_sim_ros.sim.world import StepResult

__all__ = ["SOUND_SENSOR", "run_with_sound"]

SOUND_SENSOR = "loudspeaker"
"""The sensor whose readings `run_with_sound` needs."""


def run_with_sound(engine: Engine, steps: Iterable[StepResult], file: Path) -> None:
    """Run these steps and write the sound of all loudspeakers to a file. Raises OSError, if possible before the run."""
    with replacing(str(file)) as whole:
        first = engine.now_ns // SAMPLE_NS
        streams: dict[str, SoundStream] = {}
        for step in steps:
            for robot, _sensor, reading in step.readings:
                if isinstance(reading, LoudspeakerReading):
                    streams.setdefault(robot, SoundStream()).hear(reading)
        wav.write(whole, mixed(list(streams.values()), first, engine.now_ns // SAMPLE_NS))
