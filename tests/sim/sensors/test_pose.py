"""Odometry and truth as they are read."""

from __future__ import annotations

import pytest

from tests.sim.builders import FLOOR, make, readings, run, send
from tests.sim.fake_view import FakeView, measure
from thymio_sim_ros.sim.commands import (
    BodyTwist,
    MotorTargets,
    MoveRobot,
    ResetOdometry,
)
from thymio_sim_ros.sim.model.geometry import Pose, Twist
from thymio_sim_ros.sim.model.readings import PoseReading
from thymio_sim_ros.sim.sensors import pose
from thymio_sim_ros.sim.world import World


@pytest.fixture
def world() -> World:
    return World(make([FLOOR]), noise=False)


def test_the_pose_has_odometry_and_truth() -> None:
    reading = measure(pose.SENSOR, FakeView(pose=Pose(1.0, 2.0, 3.0), twist=Twist(0.1, 0.2)))
    assert isinstance(reading, PoseReading)
    assert (reading.truth, reading.truth_twist) == (Pose(1.0, 2.0, 3.0), Twist(0.1, 0.2))
    assert (reading.odometry, reading.odometry_twist) == (Pose(0.0, 0.0, 0.0), Twist(0.0, 0.0))


def test_odometry_counts_from_the_start_and_truth_from_the_world() -> None:
    world = World(make([FLOOR], [{"name": "thymio", "x_m": 1.0, "y_m": -1.0, "yaw_rad": 1.5}]), noise=False)
    send(world, BodyTwist(0.1, 0.5))
    (*_, last) = readings(run(world, 2.0), "pose")
    assert (last.truth.x_m, last.truth.y_m) == pytest.approx(
        Pose(1.0, -1.0, 1.5).place((last.odometry.x_m, last.odometry.y_m)), abs=1e-6
    )
    assert last.odometry.yaw_rad == pytest.approx(1.0)
    assert (last.odometry_twist.linear_m_s, last.odometry_twist.angular_rad_s) == pytest.approx((0.1, 0.5))
    assert (last.truth_twist.linear_m_s, last.truth_twist.angular_rad_s) == pytest.approx((0.1, 0.5))


def test_slip_lets_odometry_drift_from_the_truth() -> None:
    world = World(make([FLOOR]), seed=3)
    send(world, MotorTargets(300, 300))
    (*_, last) = readings(run(world, 10.0), "pose")
    assert last.odometry.y_m == pytest.approx(0.0, abs=1e-9)
    assert abs(last.truth.y_m) > 1e-4


def test_odometry_does_not_notice_a_hand(world: World) -> None:
    send(world, MoveRobot(1.0, 1.0, 2.0))
    (*_, last) = readings(run(world, 0.1), "pose")
    assert (last.odometry, last.truth) == (Pose(0.0, 0.0, 0.0), Pose(1.0, 1.0, 2.0))


def test_odometry_is_reset_by_a_command(world: World) -> None:
    send(world, BodyTwist(0.1, 0.0))
    run(world, 1.0)
    send(world, BodyTwist(0.0, 0.0))
    send(world, ResetOdometry())
    (*_, last) = readings(run(world, 0.1), "pose")
    assert last.odometry == Pose(0.0, 0.0, 0.0)
    assert last.truth.x_m == pytest.approx(0.1)
