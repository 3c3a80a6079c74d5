"""Notes, the robot's own sounds, the wave of a tone."""

from __future__ import annotations

import pytest

from thymio_sim_ros.sim.audio.synthesis import BLOCK_NS, SYSTEM_SOUNDS, TRIANGLE, Note, system_sound, tone


def test_a_block_takes_as_long_as_the_robot_s_tick() -> None:
    assert BLOCK_NS == 16_384_000


def test_there_are_eight_sounds_of_the_robot() -> None:
    assert [len(sound) for sound in SYSTEM_SOUNDS] == [5, 5, 2, 3, 16, 2, 2, 3]
    assert system_sound(7) == tuple(Note(hz, 7 * BLOCK_NS) for hz in (440, 550, 660))


def test_start_up_and_shut_down_play_the_same_tones_in_reverse() -> None:
    assert [hz for hz, _ in SYSTEM_SOUNDS[0]] == [hz for hz, _ in reversed(SYSTEM_SOUNDS[1])]


@pytest.mark.parametrize("number", [-2, 8, 32767])
def test_another_number_is_a_short_tone(number: int) -> None:
    assert system_sound(number) == (Note(440, 10 * BLOCK_NS),)


@pytest.mark.parametrize(("asked", "played"), [(440, 440), (-440, 440), (0, 55.02), (32767, 3906.25)])
def test_a_tone_stays_within_what_the_robot_can_play(asked: float, played: float) -> None:
    assert tone(asked, None).frequency_hz == pytest.approx(played, abs=0.01)


def test_the_wave_at_the_start_is_a_triangle_of_142_samples() -> None:
    assert len(TRIANGLE) == 142
    assert (max(TRIANGLE), min(TRIANGLE), TRIANGLE[0]) == (127, -128, 0)
    assert TRIANGLE.index(127) < TRIANGLE.index(-128)
