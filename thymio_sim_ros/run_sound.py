"""What the loudspeakers of a run said, all together, as a sound file: `thymio-sim runner --sound FILE.wav`."""

from __future__ import annotations

from pathlib import Path

from thymio_sim_ros.device import wav
from thymio_sim_ros.runner import Runner
from thymio_sim_ros.sim.clock import TICK_NS
from thymio_sim_ros.sim.readings import LoudspeakerReading
from thymio_sim_ros.sim.sound_stream import SoundStream, mixed
from thymio_sim_ros.sim.tones import SAMPLE_NS

__all__ = ["run_with_sound"]


def run_with_sound(runner: Runner, seconds: float, file: Path) -> None:
    """Run so many simulated seconds and store what was to be heard meanwhile; OSError."""
    with file.open("ab"):
        pass  # refused before the run, not after it
    first = runner.now_ns // SAMPLE_NS
    streams: dict[str, SoundStream] = {}
    for _ in range(round(seconds * 1e9 / TICK_NS)):
        for robot, _sensor, reading in runner.step().readings:
            if isinstance(reading, LoudspeakerReading):
                streams.setdefault(robot, SoundStream()).hear(reading)
    wav.write(file, mixed(list(streams.values()), first, runner.now_ns // SAMPLE_NS))
