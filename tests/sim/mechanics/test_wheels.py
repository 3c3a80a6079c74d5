"""Wheels turn as commanded, less what an obstacle takes."""

from __future__ import annotations

import math

import pytest

from tests.sim.fake_view import FakeBody
from thymio_sim_ros.sim.mechanics import motor_control
from thymio_sim_ros.sim.mechanics import wheels as mechanics
from thymio_sim_ros.sim.mechanics.wheels import Wheels
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.noise import NoiseKeys
from thymio_sim_ros.sim.model.robot_constants import SLIP


class RollingWheels(Wheels):
    """Wheels that a test drives and rolls, by kernels as Python runs them."""

    def __init__(self) -> None:
        self.body = FakeBody()
        super().__init__(self.body)
        self._keys, self._tick = NoiseKeys(self.body.memory, 1).view, [0]

    def drive(self, left_m_s: float, right_m_s: float, *, is_noisy: bool = False) -> None:
        self.want(left_m_s, right_m_s)
        self._tick[0] += 1
        self._keys.is_on[0] = is_noisy
        motor_control.drive(self.body.wheels, self._keys, self._tick, [0])

    def roll(self, left_m_s: float, right_m_s: float) -> None:
        self.body.wheels.covered[0], self.body.wheels.covered[1] = left_m_s, right_m_s
        mechanics.roll(self.body.state, self.body.wheels)

    @property
    def ground(self) -> tuple[float, float]:
        return self.body.wheels.ground[0], self.body.wheels.ground[1]


def test_free_wheels_turn_as_commanded_whatever_the_slip() -> None:
    wheels = RollingWheels()
    wheels.drive(0.1, 0.1, is_noisy=True)
    assert wheels.ground[0] != pytest.approx(0.1, rel=1e-6)
    wheels.roll(*wheels.ground)
    assert wheels.speeds_m_s == pytest.approx((0.1, 0.1))
    assert wheels.odometry.x_m == pytest.approx(0.001)


def test_slip_is_uniform_between_its_limits_and_independent_for_each_wheel() -> None:
    wheels, factors = RollingWheels(), []
    for _ in range(2000):
        wheels.drive(0.0332, 0.0332, is_noisy=True)
        factors.append((wheels.ground[0] / 0.0332, wheels.ground[1] / 0.0332))
    left = [factor for factor, _ in factors]
    assert (min(left), max(left)) == pytest.approx(SLIP, abs=1e-3)
    assert sum(left) / len(left) == pytest.approx(1.0, abs=1e-3)
    assert all(one != other for one, other in factors)


@pytest.mark.parametrize("speed_m_s", [0.166, 0.2, -0.2])
def test_the_limit_comes_after_the_slip(speed_m_s: float) -> None:
    wheels, seen = RollingWheels(), set()
    for _ in range(200):
        wheels.drive(speed_m_s, speed_m_s, is_noisy=True)
        assert abs(wheels.ground[0]) <= 0.166
        assert abs(wheels.body.wheels.aimed[0]) == 0.166
        seen.add(abs(wheels.ground[0]))
    assert max(seen) == 0.166
    assert (len(seen) > 1) is (abs(speed_m_s) < 0.166 / SLIP[0])


def test_blocked_wheels_stand_still() -> None:
    wheels = RollingWheels()
    wheels.drive(0.1, 0.1)
    wheels.roll(0.0, 0.0)
    assert wheels.speeds_m_s == pytest.approx((0.0, 0.0))
    assert wheels.angles_rad == pytest.approx((0.0, 0.0))


def test_wheels_that_a_push_turns_count_it() -> None:
    wheels = RollingWheels()
    wheels.roll(-0.1, -0.1)
    assert wheels.odometry.x_m == pytest.approx(-0.001)


def test_odometry_follows_arcs_and_can_be_reset() -> None:
    wheels = RollingWheels()
    quarter = math.pi / 2 * 0.2
    way = (quarter * (1 - 0.047 / 0.2), quarter * (1 + 0.047 / 0.2))
    for _ in range(1000):
        wheels.roll(way[0] / 10, way[1] / 10)
    odometry = wheels.odometry
    assert (odometry.x_m, odometry.y_m, odometry.yaw_rad) == pytest.approx((0.2, 0.2, math.pi / 2), abs=1e-6)
    wheels.set_odometry(Pose(0.0, 0.0, 0.0))
    assert wheels.odometry.x_m == wheels.odometry.yaw_rad == 0.0
