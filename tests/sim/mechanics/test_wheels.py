"""Wheels turn as commanded, less what an obstacle takes."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest

from tests.sim.builders import pose_close
from thymio_sim_ros.sim.mechanics.wheels import WheelArrays, Wheels


def rolled(left_m_s: float, right_m_s: float, *, slip: float = 1.0) -> Wheels:
    wheels = Wheels()
    wheels.drive((0.1, 0.1), (slip, slip), 0.166)
    wheels.roll((left_m_s, right_m_s), 0.01)
    return wheels


def test_free_wheels_turn_as_commanded_whatever_the_slip() -> None:
    wheels = rolled(0.102, 0.102, slip=1.02)
    assert wheels.speeds_m_s == pytest.approx((0.1, 0.1))
    assert wheels.odometry.x_m == pytest.approx(0.001)


@pytest.mark.parametrize(("speed_m_s", "ground_m_s"), [(0.166, 0.1615), (0.2, 0.166), (-0.2, -0.166)])
def test_the_limit_comes_after_the_slip(speed_m_s: float, ground_m_s: float) -> None:
    wheels = Wheels()
    wheels.drive((speed_m_s, speed_m_s), (0.973, 0.973), 0.166)
    assert wheels.ground[0] == pytest.approx(ground_m_s, abs=1e-4)
    assert abs(wheels.commanded[0]) == 0.166


def test_blocked_wheels_stand_still() -> None:
    wheels = rolled(0.0, 0.0)
    assert wheels.speeds_m_s == pytest.approx((0.0, 0.0))
    assert wheels.angles_rad == pytest.approx((0.0, 0.0))


def test_wheels_that_a_push_turns_count_it() -> None:
    wheels = Wheels()
    wheels.roll((-0.1, -0.1), 0.01)
    assert wheels.odometry.x_m == pytest.approx(-0.001)


def test_odometry_follows_arcs() -> None:
    wheels = Wheels()
    quarter = math.pi / 2 * 0.2
    way = (quarter * (1 - 0.047 / 0.2), quarter * (1 + 0.047 / 0.2))
    for _ in range(1000):
        wheels.roll((way[0] / 10, way[1] / 10), 0.01)
    odometry = wheels.odometry
    assert (odometry.x_m, odometry.y_m, odometry.yaw_rad) == pytest.approx((0.2, 0.2, math.pi / 2), abs=1e-6)


def test_many_wheels_turn_as_each_would_alone() -> None:
    dice = random.Random(1)
    alone, together = [Wheels() for _ in range(4)], [Wheels() for _ in range(4)]
    arrays = WheelArrays(together)
    for tick in range(50):
        pairs = [(dice.uniform(-0.3, 0.3), dice.uniform(-0.3, 0.3)) for _ in alone]
        slips = [(dice.uniform(0.9, 1.1), dice.uniform(0.9, 1.1)) for _ in alone]
        taken = [dice.choice((0.0, 0.01)) for _ in alone]
        for wheels, pair, slip, less in zip(alone, pairs, slips, taken, strict=True):
            wheels.drive(pair, slip, 0.166)
            wheels.roll((wheels.ground[0] - less, wheels.ground[1]), 0.01)
        arrays.drive(np.array(pairs).T, np.array(slips).T, 0.166)
        arrays.roll(arrays.ground - np.array([taken, [0.0] * 4]), 0.01)
        if tick == 20:
            arrays.write_back()
            together[1].reset_odometry()
            alone[1].reset_odometry()
    arrays.write_back()
    for one, other in zip(alone, together, strict=True):
        assert other.speeds_m_s == pytest.approx(one.speeds_m_s, abs=1e-12)
        assert other.angles_rad == pytest.approx(one.angles_rad, abs=1e-12)
        assert pose_close(other.odometry, one.odometry, 1e-12)
        assert (other.commanded, other.ground) == (one.commanded, one.ground)
