"""Bodies: known motions, walls, contacts."""

from __future__ import annotations

import math
from typing import Any

import pymunk
import pytest

from tests.sim.builders import FLOOR, ROBOT, box, make, pose_close, run, send
from thymio_sim_ros.sim.commands import MotorTargets, MoveObject, MoveRobot
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.physics.contact import SUB_STEPS
from thymio_sim_ros.sim.world import World


def quiet(*shapes: dict[str, Any], robots: tuple[dict[str, Any], ...] = (ROBOT,)) -> World:
    return World(make([FLOOR, *shapes], robots), noise=False)


def test_equal_targets_drive_straight() -> None:
    world = quiet()
    send(world, MotorTargets(500, 500))
    run(world, 2.0)
    pose = world.robots["thymio"].pose
    assert (pose.x_m, pose.y_m, pose.yaw_rad) == pytest.approx((0.332, 0.0, 0.0), abs=1e-9)


def test_opposite_targets_turn_on_the_spot() -> None:
    world = quiet()
    send(world, MotorTargets(-100, 100))
    run(world, 3.0)
    pose = world.robots["thymio"].pose
    assert (pose.x_m, pose.y_m) == pytest.approx((0.0, 0.0), abs=1e-9)
    assert pose.yaw_rad == pytest.approx(3.0 * 2 * 0.0332 / 0.094)


def test_unequal_targets_drive_a_circle() -> None:
    world = quiet()
    send(world, MotorTargets(200, 300))
    run(world, 5.0)
    radius, turn = 0.094 / 2 * 5, 5.0 * 0.0332 / 0.094
    pose = world.robots["thymio"].pose
    expected = (radius * math.sin(turn), radius * (1 - math.cos(turn)), turn)
    assert (pose.x_m, pose.y_m, pose.yaw_rad) == pytest.approx(expected, abs=1e-6)


def test_a_wall_stops_the_robot_and_the_contact_is_new_once() -> None:
    world = quiet({**box(0.31, 0.0, 0.02, 1.0), "name": "wall"})
    send(world, MotorTargets(400, 400))
    contacts = [contact for step in run(world, 4.0) for contact in step.contacts]
    assert world.robots["thymio"].pose.x_m == pytest.approx(0.22, abs=0.001)
    assert {(contact.robot, contact.other) for contact in contacts} == {("thymio", "wall")}
    assert [contact.is_new for contact in contacts].count(True) == 1
    assert contacts[0].speed_m_s == pytest.approx(400 * 0.000332, rel=0.01)
    assert (contacts[0].x_m, contacts[0].y_m) == pytest.approx((0.3, 0.0), abs=0.03)


def test_a_robot_leaves_a_wall_backwards_at_once() -> None:
    world = quiet(box(0.31, 0.0, 0.02, 1.0))
    send(world, MotorTargets(500, 500))
    run(world, 2.0)
    send(world, MotorTargets(-500, -500))
    steps = run(world, 1.0)
    assert steps[-1].contacts == ()
    assert world.robots["thymio"].pose.x_m == pytest.approx(0.22 - 0.166, abs=0.004)


def test_wheels_stand_still_at_a_wall_and_odometry_does_not_run_on() -> None:
    world = quiet(box(0.31, 0.0, 0.02, 1.0))
    send(world, MotorTargets(500, 500))
    run(world, 4.0)
    wheels = world.robots["thymio"].wheels
    assert wheels.speeds_m_s == pytest.approx((0.0, 0.0), abs=1e-3)
    assert wheels.odometry.x_m == pytest.approx(world.robots["thymio"].pose.x_m, abs=0.001)


def test_nothing_moves_through_a_thin_wall_or_a_post() -> None:
    post = {"kind": "cylinder", "x_m": 0.2, "y_m": 0.01, "radius_m": 0.005, "height_m": 0.1, "color": "#808080"}
    for obstacle in (box(0.2, 0.0, 0.002, 1.0), post):
        world = quiet(obstacle)
        send(world, MotorTargets(500, 500))
        assert run(world, 3.0)[-1].contacts or obstacle is post
        assert world.robots["thymio"].pose.x_m < 0.2 or abs(world.robots["thymio"].pose.y_m) > 0.04


def test_a_robot_pushes_an_idle_one_away_and_both_feel_it() -> None:
    world = quiet(robots=(ROBOT, {**ROBOT, "name": "idle", "x_m": 0.2}))
    send(world, MotorTargets(300, 300))
    contacts = [contact for step in run(world, 4.0) for contact in step.contacts]
    assert world.robots["idle"].pose.x_m > 0.25
    assert {(contact.robot, contact.other) for contact in contacts} == {("thymio", "idle"), ("idle", "thymio")}


def test_two_equal_robots_head_on_stop_each_other() -> None:
    world = quiet(robots=(ROBOT, {**ROBOT, "name": "other", "x_m": 0.3, "yaw_rad": math.pi}))
    send(world, MotorTargets(300, 300))
    world.post("other", MotorTargets(300, 300))
    run(world, 1.2)
    assert world.robots["thymio"].pose.x_m == pytest.approx(0.07, abs=0.005)


def test_a_moved_robot_is_where_it_was_put_at_rest_and_touches_nothing() -> None:
    world = quiet(box(0.31, 0.0, 0.02, 1.0))
    send(world, MotorTargets(500, 500))
    run(world, 2.0)
    send(world, MotorTargets(0, 0))
    send(world, MoveRobot(-0.5, 0.25, 1.0))
    step = world.step()
    assert pose_close(world.robots["thymio"].pose, Pose(-0.5, 0.25, 1.0), 1e-5)
    assert step.contacts == ()
    assert world.robots["thymio"].twist.linear_m_s == pytest.approx(0.0, abs=1e-4)


def test_a_driving_robot_that_is_moved_to_a_wall_stops_at_it() -> None:
    world = quiet({**box(1.0, 0.0, 0.02, 1.0), "name": "wall"})
    run(world, 1.0)
    send(world, MoveRobot(0.9, 0.0, 0.0))
    send(world, MotorTargets(500, 500))
    steps = run(world, 1.0)
    assert [contact.other for contact in steps[-1].contacts] == ["wall"]
    assert world.robots["thymio"].pose.x_m == pytest.approx(0.91, abs=0.001)


def test_two_driving_robots_meet() -> None:
    world = quiet(robots=(ROBOT, {**ROBOT, "name": "other", "x_m": 1.0, "yaw_rad": math.pi}))
    send(world, MotorTargets(500, 500))
    world.post("other", MotorTargets(500, 500))
    contacts = [contact for step in run(world, 3.0) for contact in step.contacts]
    assert contacts[0].is_new
    assert world.robots["thymio"].pose.x_m == pytest.approx(0.42, abs=0.01)


def test_while_nothing_can_move_the_engine_rests(monkeypatch: pytest.MonkeyPatch) -> None:
    steps = []
    step = pymunk.Space.step

    def counted(space: pymunk.Space, dt: float) -> None:
        steps.append(dt)
        step(space, dt)

    monkeypatch.setattr(pymunk.Space, "step", counted)

    def stepped(seconds: float) -> bool:
        steps.clear()
        run(world, seconds)
        return len(steps) == round(seconds / 0.01) * SUB_STEPS

    light = {**box(0.2, 0.5, 0.05, 0.05), "name": "light", "mass_kg": 0.02}
    world = quiet({**box(0.31, 0.0, 0.02, 1.0), "name": "wall"}, light)
    run(world, 0.5)
    assert not stepped(1.0)
    assert steps == []
    send(world, MotorTargets(200, 200))
    assert stepped(0.5)
    send(world, MotorTargets(0, 0))
    run(world, 0.5)
    assert not stepped(0.1)
    send(world, MoveRobot(0.0, 0.0, 1.0))
    assert not stepped(0.1)
    assert steps  # a robot that was placed may touch something
    world.post("light", MoveObject(-1.0, 0.0, 0.0))
    send(world, MoveRobot(-0.5, 0.0, 0.0))
    run(world, 0.5)
    assert not stepped(0.1)
