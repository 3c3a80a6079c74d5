"""The kernel of rays gives the bits of numpy, compiled and run by Python."""

from __future__ import annotations

import random
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

from tests.sim.raycast.test_batch import FAN, scatter, things
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.raycast.batch import BatchRaycaster
from thymio_sim_ros.sim.raycast.scalar import Obstacle


def rows(poses: Sequence[Pose]) -> Any:
    return np.array([(pose.x_m, pose.y_m, pose.yaw_rad) for pose in poses]).reshape(-1, 3)


@pytest.mark.usefixtures("kernels")
@pytest.mark.parametrize("seed", range(12))
def test_random_scenes_come_out_bit_for_bit(seed: int) -> None:
    dice = random.Random(seed)
    fixed, loose = things(dice, 10, 1.5), things(dice, 4, 1.5)
    casters = [BatchRaycaster(fixed, loose, is_compiled=is_compiled) for is_compiled in (False, True)]
    poses, gone = scatter(dice, dice.choice((1, 2, 15)), 1.5), frozenset[int]()
    for step in range(8):
        now: list[Obstacle | None] = [None if step > 5 and dice.random() < 0.5 else thing for thing in loose]
        if step == 6:
            gone = frozenset({0})
        (sensors, distances), (same_sensors, same_distances) = (
            (caster.move(dict(enumerate(now)), gone), caster.cast(rows(poses), FAN))[1] for caster in casters
        )
        assert same_sensors.tolist() == sensors.tolist()
        assert same_distances.tolist() == distances.tolist()
        poses = [Pose(p.x_m + dice.uniform(-0.03, 0.03), p.y_m, p.yaw_rad + dice.uniform(-1, 1)) for p in poses]


def test_more_that_is_near_than_at_first_finds_room() -> None:
    dice = random.Random(1)
    fixed = things(dice, 120, 1.0)
    far, near = [Pose(40.0 + 3 * index, 40.0, 0.0) for index in range(12)], scatter(dice, 12, 1.0)
    casters = [BatchRaycaster(fixed, is_compiled=is_compiled) for is_compiled in (False, True)]
    for poses in (far, near, far):
        expected, found = (caster.cast(rows(poses), FAN) for caster in casters)
        assert [part.tolist() for part in found] == [part.tolist() for part in expected]
