"""Speed, pwm and angles of the wheels as they are read."""

from __future__ import annotations

import pytest

from tests.sim.builders import FLOOR, make, readings, run, send
from thymio_sim_ros.sim.commands import (
    MotorTargets,
)
from thymio_sim_ros.sim.world import World


@pytest.fixture
def world() -> World:
    return World(make([FLOOR]), noise=False)


def test_the_motor_reads_speed_pwm_and_angles(world: World) -> None:
    send(world, MotorTargets(100, -500))
    (reading,) = readings([world.step()], "motor")
    assert reading.words == (100, -500, -160, 800)
    assert reading.velocities_rad_s == pytest.approx((0.0332 / 0.022, -0.166 / 0.022))
    assert reading.angles_rad == pytest.approx((0.000332 / 0.022, -0.00166 / 0.022))


def test_wheel_angles_are_not_wrapped(world: World) -> None:
    send(world, MotorTargets(500, 500))
    (*_, last) = readings(run(world, 5.0), "motor")
    assert last.angles_rad == pytest.approx((0.83 / 0.022, 0.83 / 0.022))
