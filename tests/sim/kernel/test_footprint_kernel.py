"""The kernel of footprints gives the bits of numpy, compiled and run by Python."""

from __future__ import annotations

import random

import numpy as np
import pytest

from thymio_sim_ros.sim.ground.sampling import Ground
from thymio_sim_ros.sim.model.primitives import Color, Floor, Paint

CELL_SIDE_M = 0.6


def area(dice: random.Random, size_m: float) -> tuple[tuple[float, float], ...]:
    left, bottom = dice.uniform(-0.1, CELL_SIDE_M), dice.uniform(-0.1, CELL_SIDE_M)
    right, top = left + dice.uniform(0.002, size_m), bottom + dice.uniform(0.002, size_m)
    return ((left, bottom), (right, bottom), (right, top), (left, top))


def color(dice: random.Random) -> Color:
    return (dice.random(), dice.random(), dice.random())


def grounds(dice: random.Random) -> list[Ground]:
    """The same ground with numpy and with kernels: floors with gaps between them, painted."""
    floors = [Floor(f"floor {number}", area(dice, CELL_SIDE_M), color(dice)) for number in range(3)]
    paints = [Paint(f"paint {number}", area(dice, 0.1), color(dice)) for number in range(60)]
    return [Ground(floors, paints, is_compiled=is_compiled) for is_compiled in (False, True)]


@pytest.mark.usefixtures("kernels")
@pytest.mark.parametrize("seed", range(8))
def test_random_grounds_are_seen_bit_for_bit_while_they_are_drawn_on(seed: int) -> None:
    dice = random.Random(seed)
    both = grounds(dice)
    seen = set[float]()
    for step in range(8):
        count = 100 if step % 3 else 160
        poses = np.array([(dice.uniform(-0.05, 0.65), dice.uniform(-0.05, 0.65), dice.random()) for _ in range(count)])
        points = np.array([(dice.uniform(-0.05, 0.05), dice.uniform(-0.05, 0.05)) for _ in range(1 + step % 2)])
        (grays, floors), (same_greys, same_floors) = (ground.sample_under(poses, points) for ground in both)
        assert grays.shape == (count, len(points))
        assert same_greys.tolist() == grays.tolist()
        assert same_floors.tolist() == floors.tolist()
        seen.update(grays.ravel().tolist())
        line = [dice.uniform(0.0, CELL_SIDE_M) for _ in range(4)]
        pen = None if step == 5 else color(dice)
        for ground in both:
            ground.draw_segment(*line, 0.02, pen)
            if step == 6:
                ground.restore()
    assert len(seen) > 40
