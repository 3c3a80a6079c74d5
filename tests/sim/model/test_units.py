"""SI ↔ Thymio integers at the values of docs/spec/thymio-robot.md."""

from __future__ import annotations

import pytest

from thymio_sim_ros.sim.model import units


@pytest.mark.parametrize(("target", "speed"), [(0, 0.0), (100, 0.0332), (500, 0.166), (600, 0.1992), (-500, -0.166)])
def test_targets_are_ground_speeds(target: int, speed: float) -> None:
    assert units.units_to_speed(target) == pytest.approx(speed)


@pytest.mark.parametrize("target", range(-500, 501, 7))
def test_a_speed_reads_as_the_target_that_gave_it(target: int) -> None:
    assert units.speed_to_units(units.units_to_speed(target)) == target


@pytest.mark.parametrize(("speed", "pwm"), [(100, -160), (-100, 160), (500, -800), (600, -801)])
def test_pwm_has_the_opposite_sign_of_the_speed(speed: int, pwm: int) -> None:
    assert units.units_to_pwm(speed) == pwm


@pytest.mark.parametrize(
    ("distance_cm", "count"),
    [(0.5, 4491), (1, 4448), (2, 4278), (3, 4019), (4, 3705), (5, 3366), (8, 2409), (10, 1908), (14, 1226), (15, 0)],
)
def test_proximity_responds_as_the_table_says(distance_cm: float, count: int) -> None:
    assert units.proximity_response(distance_cm / 100) == pytest.approx(count, abs=0.6)


@pytest.mark.parametrize("distance", [0.01, 0.03, 0.08, 0.14])
def test_the_distance_of_a_count_undoes_the_response(distance: float) -> None:
    assert units.proximity_distance(units.proximity_response(distance)) == pytest.approx(distance)


@pytest.mark.parametrize(("count", "distance"), [(5000, 0.0), (4505, 0.0), (1, 0.14)])
def test_the_distance_of_a_count_stays_in_the_range(count: int, distance: float) -> None:
    assert units.proximity_distance(count) == distance


@pytest.mark.parametrize(
    ("gray", "count"),
    [(0, 77), (0.1, 100), (0.2, 151), (0.3, 255), (0.4, 423), (0.5, 619), (0.6, 775), (0.8, 911), (1, 938)],
)
def test_the_ground_responds_as_the_table_says(gray: float, count: int) -> None:
    assert units.ground_response(gray) == pytest.approx(count, abs=0.6)


@pytest.mark.parametrize(
    ("word", "level"), [(0, 0), (31, 31), (32, 32), (33, 32), (-1, 32), (256, 0), (257, 1), (288, 32)]
)
def test_a_led_word_keeps_its_low_byte_and_saturates(word: int, level: int) -> None:
    assert units.saturate_led(word) == level
