"""Generators that depend on seed, robot and user alone; banks that draw ahead for many of them."""

from __future__ import annotations

import random
import statistics

import numpy as np
import pytest

from thymio_sim_ros.sim.model.noise import Noise, NormalBank, UniformBank


def draws(noise: Noise) -> list[float]:
    return [noise.gauss(1.0) for _ in range(5)] + [noise.uniform(0.0, 1.0) for _ in range(5)]


def users(count: int, *, enabled: bool = True) -> list[Noise]:
    return [Noise(1, f"robot_{index}", "ground", enabled=enabled) for index in range(count)]


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


def test_a_bank_gives_each_user_its_own_uniform_numbers() -> None:
    alone, together = users(3), users(3)
    bank = UniformBank(together)
    for count in (2, 100, 1, 77, 128):
        expected = [[noise.uniform(0.973, 1.027) for _ in range(count)] for noise in alone]
        assert bank.draw(0.973, 1.027, count).T.tolist() == expected


def test_a_bank_gives_each_user_its_own_normal_numbers() -> None:
    dice = random.Random(3)
    alone, together = users(5), users(5)
    for noise in (*alone[:2], *together[:2]):
        noise.gauss(1.0)
    bank = NormalBank(together)
    for _ in range(300):
        turns = sorted(dice.choices(range(5), k=dice.randrange(12)))
        expected = [alone[user].gauss(3.0) for user in turns]
        assert bank.draw(np.array(turns, dtype=np.intp), 3.0) == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("used", [0, 1, 2, 127, 128, 129, 301])
def test_what_a_bank_has_not_used_it_gives_back(used: int) -> None:
    alone, together = users(2), users(2)
    bank = NormalBank(together)
    for _ in range(used):
        bank.draw(np.array([0]), 1.0)
    bank.release()
    drawn = [alone[0].gauss(1.0) for _ in range(used + 400)][used:]
    assert [together[0].gauss(1.0) for _ in range(400)] == pytest.approx(drawn, abs=1e-12)
    assert together[1].gauss(1.0) == alone[1].gauss(1.0)


@pytest.mark.parametrize("used", [0, 3, 128])
def test_even_numbers_are_given_back_too_and_may_be_banked_again(used: int) -> None:
    alone, together = users(2), users(2)
    bank = UniformBank(together)
    bank.draw(0.0, 1.0, used)
    bank.release()
    again = UniformBank(together)
    expected = [noise.uniform(0.0, 1.0) for noise in alone for _ in range(used + 300)]
    assert [number for row in again.draw(0.0, 1.0, 300).T.tolist() for number in row] == (
        expected[used : used + 300] + expected[2 * used + 300 :]
    )


def test_a_bank_of_the_quiet_is_quiet() -> None:
    quiet = users(2, enabled=False)
    assert NormalBank(quiet).draw(np.array([0, 1]), 10.0).tolist() == [0.0, 0.0]
    assert UniformBank(quiet).draw(0.973, 1.027, 1).tolist() == [[1.0, 1.0]]
