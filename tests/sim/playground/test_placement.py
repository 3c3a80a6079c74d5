"""Robots added, taken away and moved, things moved, while the world goes on; and refused where something stands."""

from __future__ import annotations

import math
import random
from typing import Any

import pytest

from tests.sim.builders import FLOOR, GRAY, ROBOT, box, make, pose_close, readings, run, send
from thymio_sim_ros.sim.commands import MotorTargets, MoveObject, MoveRobot
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.playground.placement import Footprint, Occupied, PlacementError
from thymio_sim_ros.sim.playground.reader import RobotStart
from thymio_sim_ros.sim.world import World

WALL = {**box(0.5, 0.0, 0.02, 1.0), "name": "wall"}
CRATE = {**box(-0.5, 0.0, 0.06, 0.06), "name": "crate", "mass_kg": 0.1}
POST = {"kind": "cylinder", "name": "post", "x_m": 0.0, "y_m": 0.5, "radius_m": 0.05, "height_m": 0.1, "color": GRAY}


def build(**options: Any) -> World:
    return World(make([FLOOR, WALL, CRATE, POST]), **options)


def crate(world: World) -> Pose:
    return world.snapshot().objects[0].pose


def test_a_robot_that_is_added_stands_there_and_measures_from_then_on() -> None:
    world = build()
    run(world, 0.5)
    world.spawn(RobotStart("late", -1.0, -1.0, 0.5))
    assert list(world.robots) == ["thymio", "late"]
    names = {robot for step in run(world, 0.1) for robot, _, _ in step.readings}
    assert names == {"thymio", "late"}
    assert world.robots["late"].pose == Pose(-1.0, -1.0, 0.5)


def test_an_added_robot_is_driven_pushed_and_seen_like_any_other() -> None:
    world = build(noise=False)
    world.spawn(RobotStart("late", 0.0, -0.2, math.pi / 2))
    world.post("late", MotorTargets(300, 300))
    contacts = {contact.other for step in run(world, 3.0) for contact in step.contacts}
    assert {"late", "thymio"} <= contacts
    assert world.robots["thymio"].pose.y_m > 0.02


@pytest.mark.parametrize(
    ("x_m", "y_m", "blocker"), [(0.45, 0.1, "wall"), (0.05, 0.5, "post"), (-0.55, 0.0, "crate"), (0.1, 0.05, "thymio")]
)
def test_a_robot_is_refused_where_something_stands(x_m: float, y_m: float, blocker: str) -> None:
    world = build()
    text = rf"'late' cannot be placed at {x_m:.3f}, {y_m:.3f} m: occupied by '{blocker}'"
    with pytest.raises(PlacementError, match=text):
        world.spawn(RobotStart("late", x_m, y_m))
    assert list(world.robots) == ["thymio"]


@pytest.mark.parametrize("name", ["thymio", "wall", "floor"])
def test_a_name_that_is_taken_is_refused(name: str) -> None:
    with pytest.raises(ValueError, match=f"the name '{name}' is taken"):
        build().spawn(RobotStart(name, 1.5, 1.5))


def test_a_removed_robot_is_gone_for_all_others() -> None:
    world = World(make([FLOOR], (ROBOT, {**ROBOT, "name": "other", "x_m": 0.12})), noise=False)
    send(world, MotorTargets(500, 500))
    assert run(world, 1.0)[-1].contacts
    world.post("other", MotorTargets(100, 100))
    world.remove("other")
    assert list(world.robots) == ["thymio"]
    steps = run(world, 1.0)
    assert {robot for step in steps for robot, _, _ in step.readings} == {"thymio"}
    assert all(step.contacts == () for step in steps)
    assert readings(steps, "proximity")[-1].words == (0,) * 7


def test_a_fallen_robot_can_be_taken_away_and_its_name_used_again() -> None:
    world = build()
    send(world, MoveRobot(3.0, 0.0, 0.0))
    run(world, 0.1)
    world.remove("thymio")
    world.spawn(RobotStart("thymio", 0.0, 0.0))
    run(world, 0.1)
    assert world.robots["thymio"].pose == Pose(0.0, 0.0, 0.0)


def test_an_unknown_robot_cannot_be_taken_away() -> None:
    with pytest.raises(KeyError):
        build().remove("unknown")


def test_reset_brings_back_the_robots_of_the_playground() -> None:
    world = build()
    world.spawn(RobotStart("late", -1.0, -1.0))
    world.remove("thymio")
    world.reset()
    assert list(world.robots) == ["thymio"]


def test_robots_may_come_and_go_in_a_crowd() -> None:
    world = World(make([FLOOR], [{**ROBOT, "name": f"r{index}", "x_m": index * 0.2} for index in range(7)]))
    run(world, 0.1)
    world.remove("r3")
    world.remove("r4")
    run(world, 0.1)
    world.spawn(RobotStart("late", 0.6, 0.0))
    names = list(dict.fromkeys(robot for robot, _, _ in run(world, 0.1)[-1].readings))
    assert names == ["r0", "r1", "r2", "r5", "r6", "late"]


def test_others_keep_their_noise_when_a_robot_comes() -> None:
    def path(*, late: bool) -> Pose:
        world = build(seed=3)
        send(world, MotorTargets(-100, -80))
        run(world, 1.0)
        if late:
            world.spawn(RobotStart("late", -1.5, 1.5))
        run(world, 1.0)
        return world.robots["thymio"].pose

    assert pose_close(path(late=True), path(late=False))


def test_an_object_is_moved_at_the_next_tick() -> None:
    world = build()
    world.post("crate", MoveObject(1.0, 1.0, 0.3))
    assert crate(world) == Pose(-0.5, 0.0, 0.0)
    world.step()
    assert pose_close(crate(world), Pose(1.0, 1.0, 0.3))


def test_a_moved_object_stops_robots_where_it_is_now() -> None:
    world = build(noise=False)
    run(world, 1.0)
    world.post("crate", MoveObject(0.2, 0.0, 0.0))
    send(world, MotorTargets(200, 200))
    steps = run(world, 2.0)
    assert "crate" in {contact.other for step in steps for contact in step.contacts}


def test_a_moved_object_may_fall_over_the_edge_and_come_back() -> None:
    world = World(make([FLOOR, CRATE]))
    world.post("crate", MoveObject(5.0, 0.0, 0.0))
    run(world, 0.1)
    assert world.snapshot().objects[0].is_fallen
    world.post("crate", MoveObject(0.5, 0.0, 0.0))
    run(world, 0.1)
    assert not world.snapshot().objects[0].is_fallen


def test_an_object_is_refused_where_something_stands() -> None:
    with pytest.raises(PlacementError, match=r"'crate' cannot be placed at 0\.050, 0\.000 m: occupied by 'thymio'"):
        build().post("crate", MoveObject(0.05, 0.0, 0.0))


def test_a_round_object_is_refused_where_a_round_one_stands() -> None:
    can = {**POST, "name": "can", "x_m": 1.0, "mass_kg": 0.1}
    world = World(make([FLOOR, POST, can]))
    with pytest.raises(PlacementError, match="occupied by 'post'"):
        world.post("can", MoveObject(0.05, 0.5, 0.0))
    world.post("can", MoveObject(0.11, 0.5, 0.0))


def test_a_robot_is_not_moved_into_something() -> None:
    world = build()
    with pytest.raises(PlacementError, match="occupied by 'wall'"):
        send(world, MoveRobot(0.5, 0.0, 0.0))


def test_a_robot_that_is_moved_while_it_pushes_stands_still_where_it_is_put() -> None:
    world = build(noise=False)
    send(world, MoveRobot(-0.38, 0.0, math.pi))
    send(world, MotorTargets(300, 300))
    run(world, 1.0)
    assert world.robots["thymio"].body.touching
    send(world, MotorTargets(0, 0))
    send(world, MoveRobot(1.0, 1.0, 0.0))
    run(world, 0.1)
    assert pose_close(world.robots["thymio"].pose, Pose(1.0, 1.0, 0.0), 1e-6)


def test_a_robot_may_be_turned_on_its_own_place() -> None:
    world = build()
    send(world, MoveRobot(0.01, 0.0, 1.0))
    world.step()
    assert world.robots["thymio"].pose.yaw_rad == pytest.approx(1.0, abs=1e-6)


def test_a_position_that_is_taken_in_the_next_step_is_not_free() -> None:
    world = build()
    world.post("crate", MoveObject(-1.0, 1.0, 0.0))
    with pytest.raises(PlacementError, match="occupied by 'crate'"):
        world.post("thymio", MoveRobot(-1.0, 1.0, 0.0))
    with pytest.raises(PlacementError, match="occupied by 'crate'"):
        world.spawn(RobotStart("late", -1.0, 1.0))
    world.spawn(RobotStart("late", -0.5, 0.0))
    world.step()
    assert world.robots["late"].pose == Pose(-0.5, 0.0, 0.0)
    assert crate(world) == Pose(-1.0, 1.0, 0.0)


@pytest.mark.parametrize("name", ["crate", "other"])
def test_nor_is_one_where_a_fallen_object_will_be_placed(name: str) -> None:
    world = World(make([FLOOR, CRATE], (ROBOT, {**ROBOT, "name": "other", "x_m": 1.0})))
    move = MoveObject if name == "crate" else MoveRobot
    world.post(name, move(5.0, 0.0, 0.0))
    run(world, 0.1)
    world.post("thymio", MoveRobot(5.0, 0.0, 0.0))
    world.post(name, move(1.0, 1.0, 0.0))
    with pytest.raises(PlacementError, match=f"occupied by '{name}'"):
        world.post("thymio", MoveRobot(1.0, 1.0, 0.0))


@pytest.mark.parametrize("place", [(math.nan, 0.0, 0.0), (0.0, math.inf, 0.0), (0.0, 0.0, math.nan)])
def test_a_place_that_is_no_number_is_refused(place: tuple[float, float, float]) -> None:
    world = World(make([{"kind": "rectangle", "size_x_m": 4, "size_y_m": 4, "color": GRAY}, CRATE]))
    with pytest.raises(ValueError, match="expected finite numbers"):
        send(world, MoveRobot(*place))
    with pytest.raises(ValueError, match="expected finite numbers"):
        world.post("crate", MoveObject(*place))
    with pytest.raises(ValueError, match=r"found (nan|inf)"):
        world.spawn(RobotStart("late", *place))


@pytest.mark.parametrize(
    "start",
    [
        RobotStart("late", 150.0, 0.0),
        RobotStart("late", 0.2, -0.3, 7.0),
        RobotStart("not a name", 0.2, -0.3),
    ],
)
def test_a_robot_that_no_file_may_hold_is_not_spawned(start: RobotStart) -> None:
    """A log of the run would keep it, and could not be read again."""
    with pytest.raises(ValueError, match="expected"):
        build().spawn(start)


@pytest.mark.parametrize(("name", "command"), [("crate", MotorTargets(0, 0)), ("thymio", MoveObject(0, 0, 0))])
def test_a_command_of_another_kind_is_refused(name: str, command: Any) -> None:
    with pytest.raises(TypeError):
        build().post(name, command)


def test_footprints_by_place_find_what_all_pairs_find() -> None:
    dice = random.Random(4)
    prints = [
        Footprint(f"disc{index}", (dice.uniform(-3, 3), dice.uniform(-3, 3)), dice.uniform(0.02, 0.6))
        for index in range(60)
    ]
    occupied = Occupied(prints)
    for _ in range(200):
        wanted = Footprint("new", (dice.uniform(-3, 3), dice.uniform(-3, 3)), dice.uniform(0.01, 0.3))
        expected = {there.name for there in prints if there.overlaps(wanted)}
        found = occupied.blocker(wanted)
        assert found in expected if expected else found is None
