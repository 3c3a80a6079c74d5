"""Kernels of noise and of counts give the bits of numpy, compiled and run by Python."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest

from thymio_sim_ros.sim.model.noise import Noise, NormalBank
from thymio_sim_ros.sim.model.robot_constants import PROXIMITY_MODELS, PROXIMITY_RANGE_M
from thymio_sim_ros.sim.model.units import PROXIMITY_FULL
from thymio_sim_ros.sim.sensors import proximity
from thymio_sim_ros.sim.sensors._proximity_binding import ProximityCounts

USERS = 5


def noises() -> list[Noise]:
    return [Noise(7, f"robot {number}", "sensor") for number in range(USERS)]


@pytest.mark.usefixtures("kernels")
@pytest.mark.parametrize("most", [3, 60])
def test_a_bank_deals_bit_for_bit(most: int) -> None:
    dice = random.Random(most)
    used = noises(), noises()
    for pair in used:
        pair[2].gauss(1.0)
    banks = [NormalBank(pair, is_compiled=is_compiled) for pair, is_compiled in zip(used, (False, True), strict=True)]
    for _ in range(400):
        turns = np.array(sorted(dice.choices(range(USERS), k=dice.randrange(most))), dtype=np.intp)
        expected, found = (bank.draw(turns, 3.0).tolist() for bank in banks)
        assert found == expected
    for bank in banks:
        bank.release()
    expected, found = ([noise.gauss(1.0) for noise in pair for _ in range(300)] for pair in used)
    assert found == expected


def distance(dice: random.Random) -> float:
    """Anything that a ray can tell: nothing, a place in its range, or a place at one of its ends."""
    ends = (
        math.inf,
        PROXIMITY_RANGE_M,
        math.nextafter(PROXIMITY_RANGE_M, 1.0),
        0.0,
        0.0003,
        math.nextafter(0.0003, 0.0),
    )
    return dice.choice(ends) if dice.random() < 0.4 else dice.uniform(0.0, PROXIMITY_RANGE_M)


@pytest.mark.usefixtures("kernels")
@pytest.mark.parametrize("model", PROXIMITY_MODELS)
def test_proximity_counts_bit_for_bit(model: str) -> None:
    dice = random.Random(3)
    cosines = proximity._COSINES[model]
    sensors = 21
    counting = ProximityCounts(sensors, model, cosines)
    seen = set[int]()
    for _ in range(300):
        numbers = np.array(sorted(dice.sample(range(sensors), dice.randint(0, sensors))), dtype=np.intp)
        distances = np.array([[distance(dice) for _ in cosines] for _ in numbers]).reshape(-1, len(cosines))
        distances[: dice.randrange(3)] = 0.0  # a robot touches a wall
        noise = np.array([dice.gauss(0.0, 10.0) for _ in numbers])
        expected = np.zeros(sensors)
        values = proximity.responses(distances, model) + noise
        expected[numbers] = np.rint(np.clip(values, 0.0, PROXIMITY_FULL))
        found = counting.count(numbers, distances, noise)
        assert found.tolist() == expected.tolist()
        seen.update(found.tolist())
    assert {0, PROXIMITY_FULL} < seen
    assert len(seen) > 500
