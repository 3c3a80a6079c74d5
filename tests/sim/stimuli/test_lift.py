"""A robot in the hand of an operator."""

from __future__ import annotations

import pytest

from tests.sim.builders import FLOOR, ROBOT, box, make, measure_one, pose_close, readings, run, send
from thymio_sim_ros.sim.commands import Lift, MotorTargets, MoveRobot
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.playground.placement import PlacementError
from thymio_sim_ros.sim.world import World

UP, DOWN = Lift(True), Lift(False)
OTHER = {"name": "other", "x_m": 0.3, "y_m": 0.0}


def test_the_wheels_of_a_lifted_robot_turn_in_the_air() -> None:
    world = World(make(), noise=False)
    send(world, MotorTargets(200, 200))
    run(world, 1.0)
    before = world.robots["thymio"].pose
    send(world, UP)
    truth = readings(run(world, 1.0), "pose")[-1]
    robot = world.robots["thymio"]
    assert (truth.truth, truth.truth_twist.linear_m_s) == (before, 0.0)
    assert truth.odometry.x_m > before.x_m + 0.02
    assert truth.height_m == world.snapshot().robots[0].height_m > 0.0
    assert not robot.is_fallen


def test_a_robot_that_is_put_down_goes_on_where_it_is() -> None:
    world = World(make(), noise=False)
    send(world, MotorTargets(200, 200))
    send(world, UP)
    run(world, 0.5)
    send(world, DOWN)
    run(world, 0.5)
    assert world.robots["thymio"].pose.x_m > 0.02
    assert world.robots["thymio"].height_m == 0.0


def test_the_ground_sensors_of_a_lifted_robot_see_nothing() -> None:
    world = World(make(), noise=False)
    assert min(measure_one(world, "ground").words[4:]) > 500
    send(world, UP)
    run(world, 0.2)
    assert measure_one(world, "ground").words[4:] == (0, 0)


def test_lifting_twice_is_lifting_once() -> None:
    world = World(make(), noise=False)
    for _ in range(2):
        send(world, UP)
        world.step()
    send(world, DOWN)
    world.step()
    assert world.robots["thymio"].is_standing
    send(world, DOWN)
    world.step()
    assert world.robots["thymio"].is_standing


def test_robots_neither_see_nor_meet_a_lifted_one() -> None:
    world = World(make([FLOOR], (ROBOT, {**OTHER, "x_m": 0.2})), noise=False)
    assert measure_one(world, "proximity").words[2] > 0
    world.post("other", UP)
    world.post("thymio", MotorTargets(300, 300))
    steps = run(world, 3.0)
    assert all(words == (0,) * 7 for words in (reading.words for reading in readings(steps, "proximity")[1:]))
    assert world.robots["thymio"].pose.x_m > 0.2
    assert not any(step.contacts for step in steps)


def test_a_lifted_robot_can_be_carried_over_anything() -> None:
    world = World(make([FLOOR, box(1.0, 0.0, 0.1, 0.1)]), noise=False)
    send(world, UP)
    send(world, MoveRobot(1.0, 0.0, 0.5))
    world.step()
    robot = world.robots["thymio"]
    assert pose_close(robot.pose, Pose(1.0, 0.0, 0.5))
    assert robot.height_m > 0.0
    with pytest.raises(PlacementError, match="box"):
        send(world, DOWN)
    send(world, MoveRobot(1.5, 0.0, 0.0))
    send(world, DOWN)
    world.step()
    assert robot.is_standing
    assert robot.pose.x_m == 1.5


def test_a_robot_that_drove_under_a_lifted_one_is_in_its_way() -> None:
    world = World(make([FLOOR], (ROBOT, OTHER)), noise=False)
    send(world, UP)
    world.post("other", MoveRobot(0.05, 0.0, 0.0))
    world.step()
    with pytest.raises(PlacementError, match="other"):
        send(world, DOWN)
    assert not world.robots["thymio"].is_standing


def test_a_fallen_robot_can_be_lifted_back_to_the_floor() -> None:
    world = World(make([FLOOR], ({**ROBOT, "x_m": 2.05},)), noise=False)
    run(world, 0.5)
    robot = world.robots["thymio"]
    assert robot.is_fallen
    send(world, UP)
    world.step()
    assert (robot.is_fallen, robot.is_standing) == (False, False)
    send(world, MoveRobot(1.0, 0.0, 0.0))
    send(world, DOWN)
    run(world, 0.5)
    assert robot.is_standing


def test_a_robot_put_down_beside_the_floor_falls() -> None:
    world = World(make(), noise=False)
    send(world, UP)
    send(world, MoveRobot(2.5, 0.0, 0.0))
    run(world, 0.2)
    assert not world.robots["thymio"].is_fallen
    send(world, DOWN)
    run(world, 0.2)
    assert world.robots["thymio"].is_fallen


def test_a_reset_puts_robots_down() -> None:
    world = World(make(), noise=False)
    send(world, UP)
    world.step()
    world.reset()
    assert world.robots["thymio"].is_standing


def test_a_lifted_robot_can_be_removed_and_others_stay() -> None:
    world = World(make([FLOOR], (ROBOT, OTHER)), noise=False)
    send(world, UP)
    world.step()
    world.remove("thymio")
    run(world, 0.1)
    assert list(world.robots) == ["other"]
