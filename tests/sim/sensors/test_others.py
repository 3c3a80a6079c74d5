"""Buttons, motor, pose and lights as they are read."""

from __future__ import annotations

import pytest

from tests.sim.builders import FLOOR, make, readings, run, send
from tests.sim.fake_view import FakeView
from thymio_sim_ros.sim.actuators.buttons import ButtonState
from thymio_sim_ros.sim.actuators.leds import LedState
from thymio_sim_ros.sim.commands import (
    LED_GROUPS,
    BodyTwist,
    MotorTargets,
    MoveRobot,
    PressButton,
    ResetOdometry,
    SetLeds,
)
from thymio_sim_ros.sim.geometry import Pose, Twist
from thymio_sim_ros.sim.readings import LedReading, MotorReading, PoseReading
from thymio_sim_ros.sim.sensors import buttons, leds, motor, pose
from thymio_sim_ros.sim.wheels import Wheels
from thymio_sim_ros.sim.world import World


@pytest.fixture
def world() -> World:
    return World(make([FLOOR]), noise=False)


def test_held_buttons_read_one_in_the_order_of_the_firmware() -> None:
    state = ButtonState()
    state.pressed["center"] = True
    reading = buttons.SENSOR.measure(FakeView(states=(state,)))
    assert reading is not None
    assert reading.words == (0, 0, 1, 0, 0)


def test_a_button_is_read_until_it_is_let_go(world: World) -> None:
    send(world, PressButton("left", pressed=True))
    held = readings(run(world, 0.1), "buttons")
    send(world, PressButton("left", pressed=False))
    released = readings(run(world, 0.1), "buttons")
    assert {reading.words for reading in held} == {(0, 1, 0, 0, 0)}
    assert {reading.words for reading in released} == {(0, 0, 0, 0, 0)}


def test_the_motor_reads_speed_pwm_and_angles() -> None:
    wheels = Wheels()
    wheels.drive((0.0332, -0.166), (1.0, 1.0), 0.166)
    wheels.roll((0.0332, -0.166), 0.01)
    reading = motor.SENSOR.measure(FakeView(wheels=wheels))
    assert isinstance(reading, MotorReading)
    assert reading.words == (100, -500, -160, 800)
    assert reading.velocities_rad_s == pytest.approx((0.0332 / 0.022, -0.166 / 0.022))
    assert reading.angles_rad == pytest.approx((0.000332 / 0.022, -0.00166 / 0.022))


def test_wheel_angles_are_not_wrapped(world: World) -> None:
    send(world, MotorTargets(500, 500))
    (*_, last) = readings(run(world, 5.0), "motor")
    assert last.angles_rad == pytest.approx((0.83 / 0.022, 0.83 / 0.022))


def test_the_pose_tells_odometry_and_truth() -> None:
    wheels = Wheels()
    view = FakeView(pose=Pose(1.0, 2.0, 3.0), twist=Twist(0.1, 0.2), wheels=wheels)
    reading = pose.SENSOR.measure(view)
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


def test_odometry_starts_again_when_told(world: World) -> None:
    send(world, BodyTwist(0.1, 0.0))
    run(world, 1.0)
    send(world, BodyTwist(0.0, 0.0))
    send(world, ResetOdometry())
    (*_, last) = readings(run(world, 0.1), "pose")
    assert last.odometry == Pose(0.0, 0.0, 0.0)
    assert last.truth.x_m == pytest.approx(0.1)


def test_lights_are_told_once_at_the_start_and_then_on_change() -> None:
    state = LedState()
    view = FakeView(states=(state,))
    first, second = leds.SENSOR.measure(view), leds.SENSOR.measure(view)
    state.levels["top"] = (1, 2, 3)
    third = leds.SENSOR.measure(view)
    assert isinstance(first, LedReading)
    assert first.groups == tuple((group, (0,) * size) for group, size in LED_GROUPS.items())
    assert second is None
    assert isinstance(third, LedReading)
    assert dict(third.groups)["top"] == (1, 2, 3)


def test_lights_are_first_told_in_the_first_step(world: World) -> None:
    assert [name for _, name, _ in world.step().readings] == ["leds", "motor"]


def test_a_set_light_is_read_within_the_period(world: World) -> None:
    run(world, 0.1)
    send(world, SetLeds("circle", (32, 0, 0, 0, 0, 0, 0, 99)))
    (reading,) = readings(run(world, 0.04), "leds")
    assert dict(reading.groups)["circle"] == (32, 0, 0, 0, 0, 0, 0, 32)
