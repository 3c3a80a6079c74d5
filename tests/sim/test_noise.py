"""Generators that depend on seed, robot and user alone."""

from __future__ import annotations

from thymio_sim_ros.sim.noise import Noise


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
