"""A loudspeaker's readings as one stream of samples."""

from __future__ import annotations

from itertools import pairwise

import pytest

from tests.sim.builders import FLOOR, make, readings, run, send
from thymio_sim_ros.sim.audio.mixer import SoundStream
from thymio_sim_ros.sim.audio.synthesis import BLOCK_SAMPLES, SAMPLE_NS, TRIANGLE
from thymio_sim_ros.sim.commands import Command, PlaySamples, PlaySystemSound, PlayTone, SetVolume, StopSound
from thymio_sim_ros.sim.model.readings import LoudspeakerReading
from thymio_sim_ros.sim.world import World

SECOND = 1_000_000_000 // SAMPLE_NS
CLICK = bytes(range(256))


def stream(*reported: tuple[float, Command]) -> SoundStream:
    """The readings of three seconds of a robot that gets these commands at these times."""
    world, heard = World(make([FLOOR])), SoundStream()
    steps = []
    for tick in range(300):
        for seconds, command in reported:
            if round(seconds * 100) == tick:
                send(world, command)
        steps += run(world, 0.01)
    for reading in readings(steps, "loudspeaker"):
        heard.hear(reading)
    return heard


def test_without_sounds_the_mixer_is_silent() -> None:
    assert set(SoundStream().samples(0, 1000).tolist()) == {0}


def test_at_the_lowest_frequency_the_wave_is_played_sample_by_sample() -> None:
    said = stream((0.0, PlayTone(0, None))).samples(0, 284)
    assert said.tolist() == [*TRIANGLE, *TRIANGLE]


def test_a_tone_has_as_many_periods_as_hertz() -> None:
    said = stream((0.0, PlayTone(440, None))).samples(0, 2 * SECOND).tolist()
    assert sum(before < 0 <= after for before, after in pairwise(said)) == pytest.approx(880, abs=2)


def test_parts_of_a_stream_join_without_a_seam() -> None:
    heard = stream((0.0, PlaySystemSound(7)))
    whole = heard.samples(0, 5000).tolist()
    parts = [sample for first in range(0, 5000, 77) for sample in heard.samples(first, 77).tolist()]
    assert parts[:5000] == whole


def test_a_sound_of_the_robot_takes_as_many_blocks_as_its_notes() -> None:
    said = stream((0.0, PlaySystemSound(7))).samples(0, SECOND).tolist()
    assert max(index for index, sample in enumerate(said) if sample) == pytest.approx(21 * BLOCK_SAMPLES, abs=4)


def test_samples_come_back_as_they_were() -> None:
    said = stream((0.5, PlaySamples(CLICK))).samples(0, SECOND)
    first = -(-500_000_000 // SAMPLE_NS)
    assert said[first : first + 256].tolist() == [sample - 128 for sample in CLICK]
    assert not said[:first].any()
    assert not said[first + 256 :].any()


def test_after_the_last_sample_is_silence_even_before_the_next_reading() -> None:
    heard = SoundStream()
    heard.hear(LoudspeakerReading(0, (), 0, 0.0, len(CLICK) * SAMPLE_NS, TRIANGLE, CLICK, 0))
    assert heard.samples(200, 100).tolist() == [sample - 128 for sample in CLICK[200:]] + [0] * 44


def test_a_sound_that_is_stopped_ends_at_once() -> None:
    said = stream((0.0, PlayTone(440, None)), (1.0, StopSound())).samples(0, 2 * SECOND)
    assert said[: SECOND - 20].any()
    assert not said[SECOND + 1 :].any()


def test_a_change_of_volume_does_not_begin_the_tone_anew() -> None:
    plain = stream((0.0, PlayTone(0, None))).samples(0, 2 * SECOND)
    softer = stream((0.0, PlayTone(0, None)), (1.0, SetVolume(2))).samples(0, 2 * SECOND)
    assert softer[:SECOND].tolist() == plain[:SECOND].tolist()
    assert softer[SECOND + 1 :].tolist() == [int(sample / 4) for sample in plain[SECOND + 1 :].tolist()]


def test_the_lowest_volume_is_silence() -> None:
    assert not stream((0.0, SetVolume(8)), (0.0, PlayTone(440, None))).samples(0, SECOND).any()
