"""One sound at a time, in simulated time; its natural end; how loud it is."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from tests.sim.builders import FLOOR, make, readings, run, send
from tests.sim.fake_view import FakeView
from thymio_sim_ros.sim.actuators.loudspeaker import ACTUATOR, LoudspeakerState
from thymio_sim_ros.sim.audio.synthesis import BLOCK_NS, SAMPLE_NS, TRIANGLE
from thymio_sim_ros.sim.commands import (
    Command,
    PlaySamples,
    PlaySystemSound,
    PlayTone,
    SetAlarm,
    SetVolume,
    SetWave,
    StopSound,
)
from thymio_sim_ros.sim.world import World

SECOND_NS = 1_000_000_000
CLICK = bytes([128] * 1000 + [228, 28] * 64 + [128] * 1000)


def play(commands: Sequence[Command], until_ns: int) -> LoudspeakerState:
    """The state after commands at time 0 and ticks until then."""
    state = LoudspeakerState()
    for command in commands:
        ACTUATOR.apply(state, command, 0)
    assert ACTUATOR.update is not None
    for now_ns in range(0, until_ns + 1, 10_000_000):
        ACTUATOR.update(state, FakeView(now_ns=now_ns), 0.01)
    return state


def test_a_tone_ends_after_its_time_and_counts_as_finished() -> None:
    tone = PlayTone(440, SECOND_NS // 2)
    before, after = play([tone], SECOND_NS // 2 - 1), play([tone], SECOND_NS // 2)
    assert (before.is_silent, before.finished) == (False, 0)
    assert (after.is_silent, after.finished) == (True, 1)


def test_a_tone_without_end_goes_on() -> None:
    assert not play([PlayTone(440, None)], 100 * SECOND_NS).is_silent


def test_a_sound_that_is_stopped_has_not_finished() -> None:
    state = play([PlayTone(440, SECOND_NS), StopSound()], 2 * SECOND_NS)
    assert (state.is_silent, state.finished) == (True, 0)


def test_a_sound_that_is_replaced_has_not_finished() -> None:
    assert play([PlayTone(440, SECOND_NS), PlayTone(220, SECOND_NS)], 2 * SECOND_NS).finished == 1


def test_the_robot_s_own_sound_plays_note_after_note() -> None:
    command = PlaySystemSound(3)
    notes = [play([command], ticks * BLOCK_NS + 10_000_000).note for ticks in (0, 7, 20)]
    assert [note.frequency_hz for note in notes if note] == [330, 440, 660]
    assert play([command], 27 * BLOCK_NS + 10_000_000).finished == 1


def test_samples_end_after_their_number() -> None:
    length_ns = len(CLICK) * SAMPLE_NS
    assert not play([PlaySamples(CLICK)], length_ns - 10_000_000).is_silent
    assert play([PlaySamples(CLICK)], length_ns + 10_000_000).finished == 1
    whole_ticks = CLICK[:625]
    assert play([PlaySamples(whole_ticks)], 70_000_000).finished == 0
    assert play([PlaySamples(whole_ticks)], 80_000_000).finished == 1


def test_the_level_is_the_swing_of_what_sounds_now() -> None:
    assert play([PlayTone(440, None)], 0).sounding_level == 255
    assert play([SetWave((10, -10) * 71), PlayTone(440, None)], 0).sounding_level == 20
    assert play([PlaySamples(CLICK)], 0).sounding_level == 0
    assert play([PlaySamples(CLICK)], 1000 * SAMPLE_NS).sounding_level == 200
    assert play([StopSound()], 0).sounding_level == 0


@pytest.mark.parametrize(("shift", "level"), [(0, 255), (1, 127), (7, 1), (8, 0)])
def test_the_volume_takes_bits_away(shift: int, level: int) -> None:
    assert play([PlayTone(440, None), SetVolume(shift)], 0).sounding_level == level


@pytest.mark.parametrize("command", [SetWave((0,) * 141), SetWave((128,) * 142), SetVolume(9), SetVolume(-1)])
def test_a_wave_or_volume_that_cannot_be_is_our_mistake(command: Command) -> None:
    with pytest.raises(ValueError, match=type(command).__name__):
        ACTUATOR.apply(LoudspeakerState(), command, 0)


def native(name: str, words: Sequence[int]) -> Command:
    (found,) = (native for native in ACTUATOR.aseba.natives if native.name == name)
    return found.command(words)


@pytest.mark.parametrize(
    ("words", "command"),
    [
        ((440, 60), PlayTone(440, 60 * BLOCK_NS)),
        ((440, 1), PlayTone(440, 4 * BLOCK_NS)),
        ((440, 0), PlayTone(440, None)),
        ((440, -1), StopSound()),
    ],
)
def test_durations_of_a_program_are_ticks(words: tuple[int, int], command: Command) -> None:
    assert native("sound.freq", words) == command


def test_a_program_s_wave_has_samples_of_8_bits() -> None:
    assert native("sound.wave", TRIANGLE) == SetWave(TRIANGLE)
    with pytest.raises(ValueError, match=r"sound.wave: sample 200 found, expected -128 to 127"):
        native("sound.wave", (0,) * 141 + (200,))


def test_a_sound_of_no_length_finishes_at_once() -> None:
    assert play([PlaySamples(b"")], 20_000_000).finished == 1


def test_the_world_reports_what_sounds_and_when_it_has_finished() -> None:
    world = World(make([FLOOR]))
    send(world, PlaySystemSound(2))
    steps = run(world, 0.5)
    reported = readings(steps, "loudspeaker")
    assert [(reading.frequency_hz, reading.duration_ns) for reading in reported] == [
        (110, 7 * BLOCK_NS), (220, 7 * BLOCK_NS), (0.0, 0)
    ]  # fmt: skip
    assert [reading.began_ns for reading in reported] == [0, 7 * BLOCK_NS, 14 * BLOCK_NS]
    (finished,) = readings(steps, "sound_finished")
    assert finished.stamp_ns == reported[-1].stamp_ns == 240_000_000


def test_the_world_reports_samples_volume_and_silence() -> None:
    world = World(make([FLOOR]))
    send(world, SetVolume(3))
    send(world, PlaySamples(CLICK))
    (playing,) = readings(run(world, 0.1), "loudspeaker")
    assert (playing.samples, playing.shift, playing.frequency_hz) == (CLICK, 3, 0.0)
    assert playing.duration_ns == len(CLICK) * SAMPLE_NS
    send(world, StopSound())
    steps = run(world, 1.0)
    (silent,) = readings(steps, "loudspeaker")
    assert (silent.samples, silent.frequency_hz) == (b"", 0.0)
    assert readings(steps, "sound_finished") == []


def test_a_silent_loudspeaker_that_is_stopped_reports_nothing() -> None:
    world = World(make([FLOOR]))
    send(world, StopSound())
    assert readings(run(world, 0.1), "loudspeaker") == []


def test_an_alarm_sounds_every_three_seconds_until_it_is_switched_off() -> None:
    world = World(make([FLOOR]))
    steps = []
    for seconds in (1.0, 6.0):
        send(world, SetAlarm(True))
        steps += run(world, seconds)
    begun = [reading.began_ns for reading in readings(steps, "loudspeaker") if reading.frequency_hz == 110]
    assert begun == [0, 3 * SECOND_NS, 6 * SECOND_NS]
    send(world, SetAlarm(False))
    run(world, 0.5)
    assert readings(run(world, 7.0), "loudspeaker") == []
