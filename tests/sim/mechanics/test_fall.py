"""Over the edge: who falls, how a fallen robot lies, what it and the others see."""

from __future__ import annotations

import math
from typing import Any

import pytest

from tests.sim.builders import FLOOR, GRAY, ROBOT, box, make, measure_one, readings, run, send
from thymio_sim_ros.sim.commands import MotorTargets, MoveObject, MoveRobot
from thymio_sim_ros.sim.mechanics.fall import FALL_NS, Fall
from thymio_sim_ros.sim.model.geometry import LEVEL, Pose, Tilt
from thymio_sim_ros.sim.world import World

EDGE_M = 2.0
SLANT_RAD = math.radians(50)


def at_edge(*shapes: dict[str, Any], yaw_rad: float = 0.0, others: tuple[dict[str, Any], ...] = ()) -> World:
    """A robot 5 cm before the right edge of the floor."""
    return World(make([FLOOR, *shapes], ({**ROBOT, "x_m": EDGE_M - 0.05, "yaw_rad": yaw_rad}, *others)), noise=False)


def test_a_robot_falls_when_its_origin_is_past_the_edge_and_not_before() -> None:
    world = at_edge()
    send(world, MotorTargets(300, 300))
    robot = world.robots["thymio"]
    while robot.tilt == LEVEL and not robot.is_falling:
        assert robot.pose.x_m < EDGE_M + 0.002
        world.step()
    assert robot.pose.x_m == pytest.approx(EDGE_M, abs=0.002)


def test_a_falling_robot_is_in_the_air_for_a_fifth_of_a_second_and_then_lies_on_its_nose() -> None:
    world = at_edge()
    send(world, MotorTargets(500, 500))
    robot = world.robots["thymio"]
    falling = [(world.step(), robot.is_falling)[1] for _ in range(100)]
    assert falling.count(True) == FALL_NS // 10_000_000
    assert robot.tilt == Tilt(pytest.approx(0.0), pytest.approx(SLANT_RAD))


def test_a_robot_that_backs_over_the_edge_lies_on_its_tail() -> None:
    world = at_edge(yaw_rad=math.pi)
    send(world, MotorTargets(-500, -500))
    run(world, 2.0)
    assert world.robots["thymio"].tilt.pitch_rad == pytest.approx(-SLANT_RAD)


def test_a_robot_pushed_sideways_over_the_edge_lies_on_its_side() -> None:
    pusher = {**ROBOT, "name": "pusher", "x_m": EDGE_M - 0.25}
    world = at_edge(yaw_rad=math.pi / 2, others=(pusher,))
    world.post("pusher", MotorTargets(500, 500))
    run(world, 3.0)
    assert world.robots["thymio"].tilt.roll_rad == pytest.approx(SLANT_RAD, abs=0.1)


@pytest.mark.parametrize(
    ("course", "tilt"), [(math.pi / 2, Tilt(-SLANT_RAD, 0.0)), (-math.pi / 2, Tilt(SLANT_RAD, 0.0))]
)
def test_the_side_that_goes_first_ends_below(course: float, tilt: Tilt) -> None:
    found = Fall(0, course).tilt(FALL_NS)
    assert (found.roll_rad, found.pitch_rad) == pytest.approx((tilt.roll_rad, tilt.pitch_rad))


def test_the_wheels_of_a_fallen_robot_turn_without_grip() -> None:
    world = at_edge()
    send(world, MotorTargets(500, 500))
    run(world, 2.0)
    before = world.robots["thymio"].pose
    angle = world.robots["thymio"].wheels.angles_rad[0]
    run(world, 1.0)
    assert world.robots["thymio"].pose == before
    assert world.robots["thymio"].wheels.angles_rad[0] - angle == pytest.approx(0.166 / 0.022)


def test_the_ground_sensors_read_nothing_before_and_after_the_fall() -> None:
    world = at_edge()
    assert measure_one(world, "ground").words == (0,) * 6
    send(world, MotorTargets(300, 300))
    assert {reading.words for reading in readings(run(world, 3.0), "ground")} == {(0,) * 6}


def test_a_fallen_robot_is_invisible_untouchable_and_sees_nothing() -> None:
    wall = box(EDGE_M + 0.11, 0.0, 0.02, 0.4)
    world = at_edge(wall, others=({**ROBOT, "name": "other", "x_m": EDGE_M - 0.3},))
    assert measure_one(world, "proximity").words[2] > 0
    send(world, MoveRobot(EDGE_M + 0.005, 0.0, 0.0))
    run(world, 1.0)
    assert measure_one(world, "proximity").words == (0,) * 7
    world.post("other", MotorTargets(500, 500))
    steps = run(world, 3.0)
    assert all(step.contacts == () for step in steps)
    assert world.robots["other"].tilt != LEVEL


def test_a_fallen_robot_stands_again_where_it_is_put() -> None:
    world = at_edge()
    send(world, MotorTargets(500, 500))
    run(world, 2.0)
    send(world, MoveRobot(0.0, 0.0, 0.0))
    run(world, 1.0)
    robot = world.robots["thymio"]
    assert (robot.tilt, robot.is_falling, robot.is_standing) == (LEVEL, False, True)
    assert robot.pose.x_m == pytest.approx(0.166)


def test_a_robot_that_is_put_where_no_floor_is_falls_at_once() -> None:
    world = World(make([FLOOR]), noise=False)
    run(world, 0.1)
    send(world, MoveRobot(EDGE_M + 0.5, 0.0, 0.0))
    run(world, 0.01)
    assert world.robots["thymio"].is_fallen


def test_reset_puts_a_fallen_robot_back() -> None:
    world = at_edge()
    send(world, MotorTargets(500, 500))
    run(world, 2.0)
    world.reset()
    assert world.robots["thymio"].pose == Pose(EDGE_M - 0.05, 0.0, 0.0)
    assert world.robots["thymio"].tilt == LEVEL


def test_no_robot_falls_where_there_is_no_floor_at_all() -> None:
    world = World(make([]), noise=False)
    send(world, MotorTargets(500, 500))
    run(world, 2.0)
    assert world.robots["thymio"].tilt == LEVEL


def test_an_object_pushed_over_the_edge_is_gone() -> None:
    place = {"x_m": EDGE_M - 0.1, "y_m": 0.0, "radius_m": 0.03, "height_m": 0.1}
    can = {"kind": "cylinder", "name": "can", **place, "color": GRAY, "mass_kg": 0.05}
    world = World(make([FLOOR, can], ({**ROBOT, "x_m": EDGE_M - 0.25},)), noise=False)
    send(world, MotorTargets(300, 300))
    while not world.snapshot().objects[0].is_fallen:
        world.step()
    assert world.snapshot().objects[0].pose.x_m == pytest.approx(EDGE_M, abs=0.003)
    assert world.robots["thymio"].tilt == LEVEL
    send(world, MotorTargets(0, 0))
    assert measure_one(world, "proximity").words == (0,) * 7


def test_an_object_that_starts_past_the_edge_is_not_there() -> None:
    crate = {**box(EDGE_M + 0.3, 0.0, 0.06, 0.06), "name": "crate", "mass_kg": 0.1}
    found = make([FLOOR, crate])
    assert found.notes == ("shapes: 'crate' starts where there is no floor",)
    world = World(found)
    assert world.objects[0].is_fallen
    world.step()
    world.post("crate", MoveObject(0.5, 0.5, 0.0))
    world.step()
    world.reset()
    assert world.objects[0].is_fallen


def test_nor_is_one_in_the_middle_of_the_world_where_the_floor_is_elsewhere() -> None:
    crate = {**box(0.0, 0.0, 0.06, 0.06), "name": "crate", "mass_kg": 0.1}
    world = World(make([{**FLOOR, "x_m": 3.0}, crate], ({**ROBOT, "x_m": 3.0},)))
    assert world.objects[0].is_fallen
