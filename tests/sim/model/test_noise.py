"""Random numbers that depend on seed, robot, user, tick and number alone."""

from __future__ import annotations

import statistics

import numpy as np
import pytest

from thymio_sim_ros.sim.model.clock import SimClock
from thymio_sim_ros.sim.model.noise import Noise, noise_keys, normal, tick_number, uniform


def draws(noise: Noise) -> list[float]:
    return [noise.gauss(1.0) for _ in range(5)] + [noise.uniform(0.0, 1.0) for _ in range(5)]


def test_the_same_key_draws_the_same() -> None:
    assert draws(Noise(1, "a", "ground")) == draws(Noise(1, "a", "ground"))


def test_seed_robot_and_user_each_matter() -> None:
    keys = [(1, "a", "ground"), (2, "a", "ground"), (1, "b", "ground"), (1, "a", "motors")]
    assert len({tuple(draws(Noise(*key))) for key in keys}) == 4


def test_switched_off_it_gives_the_middle() -> None:
    quiet = Noise(1, "a", "ground", enabled=False)
    assert (quiet.gauss(10.0), quiet.uniform(0.973, 1.027)) == (0.0, 1.0)


def test_normal_numbers_are_normal() -> None:
    noise = Noise(1, "a", "ground")
    numbers = [noise.gauss(2.0) for _ in range(20_000)]
    assert statistics.mean(numbers) == pytest.approx(0.0, abs=0.05)
    assert statistics.stdev(numbers) == pytest.approx(2.0, rel=0.02)
    assert sum(abs(number) > 4.0 for number in numbers) / len(numbers) == pytest.approx(0.0455, abs=0.005)


def test_uniform_numbers_are_uniform_and_neighbors_are_independent() -> None:
    numbers = np.array([uniform(3, 5, tick, number) for tick in range(200) for number in range(100)])
    assert np.histogram(numbers, 10, (0.0, 1.0))[0] == pytest.approx(2000, abs=200)
    for lag in (1, 2, 100):  # the next number in a tick, and the same one of the next tick
        assert abs(np.corrcoef(numbers[lag:], numbers[:-lag])[0, 1]) < 0.025


def test_a_number_depends_on_its_tick_and_not_on_earlier_ones() -> None:
    clock = SimClock()
    often, once = Noise(1, "a", "ground", clock=clock), Noise(1, "a", "ground", clock=clock)
    seen = set()
    for _ in range(50):
        clock.advance()
        numbers = draws(often)
        seen.update(numbers)
    assert draws(once) == numbers
    assert len(seen) == 50 * 10


def test_numbers_of_a_tick_do_not_overlap() -> None:
    noise, keys = Noise(1, "a", "ground"), noise_keys(1, "a", "ground")
    found = [noise.uniform(0.0, 1.0), noise.gauss(1.0), noise.uniform(0.0, 1.0)]
    assert found == [uniform(*keys, 0, 0), normal(*keys, 0, 1), uniform(*keys, 0, 4)]


def test_tick_numbers_have_31_bits() -> None:
    assert [tick_number(tick * 10_000_000) for tick in (0, 7, (1 << 31) + 3)] == [0, 7, 3]
