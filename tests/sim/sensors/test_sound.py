"""The microphone: noise, claps, loudspeakers, distance."""

from __future__ import annotations

import pytest

from tests.sim.builders import FLOOR, ROBOT, make, readings, run, send
from thymio_sim_ros.sim.actuators.microphone import MicrophoneState
from thymio_sim_ros.sim.audio.propagation import Sound
from thymio_sim_ros.sim.commands import Clap, PlayTone, SetNoiseLevel, SetSoundThreshold
from thymio_sim_ros.sim.model.readings import SoundReading
from thymio_sim_ros.sim.sensors import sound
from thymio_sim_ros.sim.world import StepResult, World

PAIR = ({**ROBOT, "name": "a"}, {**ROBOT, "name": "b", "x_m": 0.5})


def intensities(steps: list[StepResult], robot: str) -> list[int]:
    """Intensities that a robot read."""
    return [
        reading.words[0]
        for step in steps
        for name, _, reading in step.readings
        if name == robot and isinstance(reading, SoundReading)
    ]


def measured(level: int, sounds: tuple[Sound, ...] = (), threshold: int = 0) -> SoundReading:
    """One block at the origin."""
    reading = sound.report(0, sound.intensity_at(level, sounds, 0.0, 0.0), MicrophoneState(threshold), {})
    assert reading is not None
    return reading


@pytest.mark.parametrize("level", [0, 1, 2, 100, 254, 255])
def test_intensity_and_mean_come_from_samples_of_eight_bits(level: int) -> None:
    intensity, mean = measured(level).words
    largest, smallest = (mean + intensity) / 2, (mean - intensity) / 2
    assert intensity == level
    assert (largest, smallest) == (int(largest), int(smallest))
    assert 0 <= smallest <= 128 <= largest + 1 <= 256


@pytest.mark.parametrize(
    ("distance_m", "intensity"), [(0.0, 200), (0.1, 200), (0.2, 100), (0.5, 40), (2.0, 10), (100.0, 0)]
)
def test_a_sound_fades_as_one_over_the_distance(distance_m: float, intensity: int) -> None:
    assert measured(0, (Sound(0.0, distance_m, 200.0),)).words[0] == intensity


def test_energies_of_sounds_and_noise_add_up_to_a_limit() -> None:
    assert measured(30, (Sound(0.0, 0.1, 40.0),)).words[0] == 50
    assert measured(0, (Sound(0.0, 0.1, 30.0), Sound(0.1, 0.0, 40.0))).words[0] == 50
    assert measured(200, (Sound(0.0, 0.0, 250.0),)).words[0] == 255


@pytest.mark.parametrize(
    ("level", "threshold", "loud"), [(100, 0, False), (100, 100, False), (100, 99, True), (0, -1, True)]
)
def test_loud_is_above_a_threshold_that_is_set(level: int, threshold: int, loud: bool) -> None:
    assert measured(level, threshold=threshold).is_loud == loud


def test_a_clap_is_heard_in_one_or_two_blocks_wherever_it_falls() -> None:
    for tick in range(20):
        world = World(make([FLOOR]))
        run(world, 0.5 + tick * 0.01)
        send(world, SetSoundThreshold(50))
        send(world, Clap(200))
        loud = [reading for reading in readings(run(world, 0.5), "sound") if reading.is_loud]
        assert len(loud) in (1, 2)
        assert {reading.words[0] for reading in loud} == {200}


def test_a_clap_is_heard_by_other_robots_from_afar() -> None:
    world = World(make([FLOOR], PAIR))
    run(world, 0.1)
    world.post("a", Clap(250))
    steps = run(world, 0.1)
    assert (max(intensities(steps, "a")), max(intensities(steps, "b"))) == (250, 50)


def test_noise_is_heard_by_its_robot_alone() -> None:
    world = World(make([FLOOR], PAIR))
    world.post("a", SetNoiseLevel(90))
    steps = run(world, 0.1)
    assert (max(intensities(steps, "a")), max(intensities(steps, "b"))) == (90, 0)


def test_a_loudspeaker_is_heard_while_it_plays() -> None:
    world = World(make([FLOOR], PAIR))
    run(world, 0.1)
    world.post("b", PlayTone(440.0, 500_000_000))
    playing, after = run(world, 0.4), run(world, 0.5)
    assert 0 < intensities(playing, "a")[-1] < 250 < intensities(playing, "b")[-1]
    assert (intensities(after, "a")[-1], intensities(after, "b")[-1]) == (0, 0)


def test_after_a_loud_block_silence_is_news() -> None:
    memory: dict[str, int] = {}
    microphone = MicrophoneState(50)
    blocks = enumerate((0, 100, 0))
    measurements = [sound.report(n * sound.BLOCK_NS, level, microphone, memory) for n, level in blocks]
    assert [reading and reading.words[0] for reading in measurements] == [0, 100, 0]


def test_steady_sound_is_measurements_61_times_a_second_only_when_it_is_loud() -> None:
    world = World(make([FLOOR]))
    send(world, SetNoiseLevel(100))
    assert len(readings(run(world, 10.0), "sound")) == 10
    send(world, SetSoundThreshold(99))
    assert len(readings(run(world, 10.0), "sound")) in (610, 611)
