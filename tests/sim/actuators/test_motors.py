"""Targets, commands that end, limits, slip."""

from __future__ import annotations

import math

import pytest

from tests.sim.builders import FLOOR, make, post_wall, readings, run, send
from thymio_sim_ros.sim.actuators.motors import ACTUATOR, wheel_speeds
from thymio_sim_ros.sim.commands import BodyTwist, MotorTargets, WheelVelocities
from thymio_sim_ros.sim.world import World

SECOND_NS = 1_000_000_000


@pytest.fixture
def world() -> World:
    return World(make([FLOOR]), noise=False)


def speeds(world: World, seconds: float) -> list[tuple[int, int]]:
    return [reading.words[:2] for reading in readings(run(world, seconds), "motor")]


def test_targets_persist(world: World) -> None:
    send(world, MotorTargets(100, -200))
    assert set(speeds(world, 20.0)) == {(100, -200)}


def test_a_command_ends_with_its_timeout_and_the_wheels_stop(world: World) -> None:
    send(world, WheelVelocities(1.0, 1.0, timeout_ns=SECOND_NS // 2))
    seen = speeds(world, 1.0)
    assert [pair != (0, 0) for pair in seen] == [True] * 50 + [False] * 50


def test_after_a_timeout_the_last_targets_hold_again(world: World) -> None:
    send(world, MotorTargets(150, 150))
    run(world, 0.1)
    send(world, BodyTwist(0.0, 0.0, timeout_ns=SECOND_NS // 10))
    assert speeds(world, 0.2) == [(0, 0)] * 10 + [(150, 150)] * 10


def test_newer_targets_end_a_command_at_once(world: World) -> None:
    send(world, BodyTwist(0.1, 0.0))
    run(world, 0.1)
    send(world, MotorTargets(0, 0))
    assert set(speeds(world, 0.1)) == {(0, 0)}


def test_a_command_without_timeout_never_ends(world: World) -> None:
    send(world, WheelVelocities(1.0, 1.0))
    assert len(set(speeds(world, 20.0))) == 1


def test_the_last_of_several_commands_in_a_tick_counts(world: World) -> None:
    send(world, MotorTargets(100, 100))
    send(world, MotorTargets(200, 200))
    assert speeds(world, 0.01) == [(200, 200)]


def test_a_twist_becomes_wheel_speeds() -> None:
    assert wheel_speeds(BodyTwist(0.1, 1.0)) == pytest.approx((0.1 - 0.047, 0.1 + 0.047))


@pytest.mark.parametrize(("linear", "angular"), [(0.3, 0.0), (0.1, 3.0), (-0.2, -1.0), (0.0, 10.0)])
def test_a_twist_above_the_limit_keeps_its_curve(linear: float, angular: float) -> None:
    left, right = wheel_speeds(BodyTwist(linear, angular))
    assert max(abs(left), abs(right)) == pytest.approx(0.166)
    assert math.atan2((right - left) / 0.094, (left + right) / 2) == pytest.approx(math.atan2(angular, linear))


def test_wheel_velocities_are_radians_of_a_22_mm_wheel() -> None:
    assert wheel_speeds(WheelVelocities(1.0, -2.0)) == pytest.approx((0.022, -0.044))


def test_a_program_drives_by_two_variables() -> None:
    (output,) = ACTUATOR.aseba.outputs
    assert output.variables == (("motor.left.target", 1), ("motor.right.target", 1))
    assert output.command([100, -100]) == MotorTargets(100, -100)


@pytest.fixture
def controlled() -> World:
    return World(make([FLOOR]), noise=False, motor_model="firmware")


def test_the_firmware_s_motors_lag_behind_their_target(controlled: World) -> None:
    send(controlled, MotorTargets(200, 200))
    left = [pair[0] for pair in speeds(controlled, 3.0)]
    assert 0 < left[0] < 60
    assert left[-1] == pytest.approx(200, abs=2)


def test_the_firmware_s_motors_tell_output_current_and_integral(controlled: World) -> None:
    send(controlled, MotorTargets(200, -200))
    steps = run(controlled, 3.0)
    assert readings(steps, "motor")[-1].words[2:] == (pytest.approx(-320, abs=5), pytest.approx(320, abs=5))
    current_left, _, integral_left, integral_right = readings(steps, "current")[-1].words
    assert (integral_left, integral_right) == (pytest.approx(-960, abs=20), pytest.approx(960, abs=20))
    assert current_left < 30


def test_a_velocity_from_ros_goes_through_the_control_loop_too(controlled: World) -> None:
    send(controlled, BodyTwist(0.1, 0.0))
    run(controlled, 2.0)
    assert controlled.robots["thymio"].twist.linear_m_s == pytest.approx(0.1, rel=0.02)


def test_a_robot_at_a_wall_protects_its_motors(controlled: World) -> None:
    world = World(make([FLOOR, post_wall(0.01)]), noise=False, motor_model="firmware")
    send(world, MotorTargets(500, 500))
    currents = [reading.words[0] for reading in readings(run(world, 6.0), "current")]
    assert 600 < max(currents) < 650
    assert currents[-1] < 450


def test_the_motor_model_survives_a_reset(controlled: World) -> None:
    controlled.reset()
    send(controlled, MotorTargets(200, 200))
    assert speeds(controlled, 0.01)[0][0] < 60


def test_an_unknown_motor_model_is_refused() -> None:
    with pytest.raises(ValueError, match="motor model 'quick' found, expected one of ideal, firmware"):
        World(make([FLOOR]), motor_model="quick")
