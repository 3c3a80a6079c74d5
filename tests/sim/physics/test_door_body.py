"""Doors: when they open, how they move, what they do to robots."""

from __future__ import annotations

import json
import math
from itertools import pairwise
from typing import Any

import pytest

from tests.sim.builders import FLOOR, GRAY, ROBOT, make, measure_one, run, send
from thymio_sim_ros.sim.commands import MotorTargets, MoveObject, MoveRobot
from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.playground import reader
from thymio_sim_ros.sim.playground.reader import PlaygroundError
from thymio_sim_ros.sim.world import World

GATE = {
    "kind": "door", "name": "gate", "closed_x_m": 0.5, "closed_y_m": 0.0, "opened_x_m": 0.5, "opened_y_m": 0.6,
    "size_x_m": 0.02, "size_y_m": 0.6, "height_m": 0.1, "move_s": 2.0, "color": GRAY,
}  # fmt: skip
BOX = {"height_m": 0.1, "color": GRAY}
PLATE = {
    "kind": "activation", "name": "plate", "x_m": -0.5, "y_m": 0.5, "size_x_m": 0.1, "size_y_m": 0.1, "door": "gate",
    "area_m": [[-0.2, -0.2], [0.2, -0.2], [0.2, 0.2], [-0.2, 0.2]],
}  # fmt: skip


def build(*shapes: dict[str, Any]) -> World:
    return World(make([FLOOR, *shapes], (ROBOT, {**ROBOT, "name": "opener", "x_m": -1.0})), noise=False)


def enter(world: World) -> None:
    """Put the opener on the area, beside the block."""
    world.post("opener", MoveRobot(-0.5, 0.34, 0.0))


def gate_y(world: World) -> float:
    (gate,) = world.snapshot().objects
    return gate.pose.y_m


def leave(world: World) -> None:
    world.post("opener", MoveRobot(-1.0, 0.0, 0.0))


def test_a_door_stays_closed_while_no_robot_is_on_its_area() -> None:
    world = build(GATE, PLATE)
    run(world, 3.0)
    assert gate_y(world) == 0.0


@pytest.mark.parametrize(("depth_m", "is_fallen"), [(4.0, False), (1.8, True)], ids=["floor", "table"])
def test_a_door_that_flies_open_pushes_robots_far_from_it_and_from_the_edge(depth_m: float, is_fallen: bool) -> None:
    floor, gate = {**FLOOR, "size_y_m": depth_m}, {**GATE, "move_s": 0.5}
    robots = ({**ROBOT, "x_m": 0.5, "y_m": 0.55}, {**ROBOT, "name": "opener", "x_m": -0.72, "y_m": 0.34})
    world = World(make([floor, gate, PLATE], robots), noise=False)
    world.post("opener", MotorTargets(500, 500))
    run(world, 0.75)
    assert world.robots["thymio"].pose.y_m > 0.9
    assert world.robots["thymio"].is_fallen == is_fallen


def test_an_object_on_its_area_does_not_open_a_door() -> None:
    thing = {"kind": "box", "x_m": -0.5, "y_m": 0.4, "size_x_m": 0.04, "size_y_m": 0.04, "mass_kg": 0.1, **BOX}
    world = build(GATE, PLATE, thing)
    run(world, 3.0)
    assert {(body.pose.x_m, body.pose.y_m) for body in world.objects} == {(-0.5, 0.4), (0.5, 0.0)}


def test_a_door_opens_along_half_a_cosine() -> None:
    world = build(GATE, PLATE)
    enter(world)
    found = [(run(world, 0.01), gate_y(world))[1] for _ in range(250)]
    expected = [0.6 * (1 - math.cos(math.pi * min(tick, 200) / 200)) / 2 for tick in range(1, 251)]
    assert found == pytest.approx(expected, abs=1e-9)


def test_a_door_turns_back_half_way_and_closes() -> None:
    world = build(GATE, PLATE)
    enter(world)
    run(world, 1.0)
    assert gate_y(world) == pytest.approx(0.3, abs=0.01)
    leave(world)
    run(world, 1.1)
    assert gate_y(world) == 0.0


def test_a_robot_drives_through_an_open_door_only() -> None:
    def reached(*, is_open: bool) -> float:
        world = build(GATE, PLATE)
        if is_open:
            enter(world)
        send(world, MotorTargets(300, 300))
        run(world, 8.0)
        return world.robots["thymio"].pose.x_m

    assert reached(is_open=False) == pytest.approx(0.41, abs=0.002)
    assert reached(is_open=True) > 0.6


def test_a_closing_door_pushes_a_robot_that_stands_in_its_way() -> None:
    world = build(GATE, PLATE)
    enter(world)
    run(world, 2.5)
    send(world, MoveRobot(0.5, -0.1, 0.0))
    leave(world)
    run(world, 3.0)
    assert gate_y(world) == 0.0
    assert world.robots["thymio"].pose.y_m == pytest.approx(-0.3 - 0.055, abs=0.003)


def test_sensors_see_a_door_where_it_is() -> None:
    world = build({**GATE, "closed_x_m": 0.15, "opened_x_m": 0.15}, PLATE)
    closed = measure_one(world, "proximity").words[2]
    enter(world)
    run(world, 2.5)
    assert closed > 2000
    assert measure_one(world, "proximity").words[2] == 0


def test_one_of_several_areas_is_enough() -> None:
    other = {**PLATE, "name": "other", "x_m": 1.5, "y_m": 1.5}
    world = build(GATE, other, PLATE)
    enter(world)
    run(world, 2.5)
    assert gate_y(world) == 0.6


@pytest.mark.parametrize("shapes", [[PLATE], [{**GATE, "kind": "wall"}, PLATE]], ids=["none", "a wall"])
def test_an_activation_of_what_is_no_door_is_refused(shapes: list[dict[str, Any]]) -> None:
    wall = {"kind": "wall", "name": "gate", "start_x_m": 0, "start_y_m": 1, "end_x_m": 1, "end_y_m": 1, "color": GRAY}
    shapes = [wall if shape["kind"] == "wall" else shape for shape in shapes]
    text = json.dumps({"format": 1, "title": "test", "shapes": shapes, "robots": []})
    with pytest.raises(PlaygroundError, match=r"\.door: found 'gate', expected .*; the playground has none"):
        reader.loads(text, "test")


def test_a_closing_door_pushes_an_object_at_rest() -> None:
    crate = {"kind": "box", "name": "crate", "x_m": 0.5, "y_m": -0.1, "size_x_m": 0.06, "size_y_m": 0.06}
    world = build({**GATE, "closed_y_m": 0.6, "opened_y_m": 0.0}, PLATE, {**crate, **BOX, "y_m": -0.4, "mass_kg": 0.5})
    run(world, 1.0)
    enter(world)
    run(world, 3.0)
    (crate_now, _) = world.snapshot().objects
    assert crate_now.pose.y_m == pytest.approx(-0.3 - 0.03, abs=0.08)
    assert crate_now.pose.y_m < -0.32


def test_a_robot_between_a_door_and_a_wall_is_squeezed_and_not_thrown() -> None:
    wall = {"kind": "wall", "start_x_m": 0.3, "start_y_m": -0.42, "end_x_m": 0.7, "end_y_m": -0.42, "color": GRAY}
    world = build(GATE, PLATE, wall)
    enter(world)
    run(world, 2.5)
    send(world, MoveRobot(0.5, -0.1, math.pi / 2))
    leave(world)
    world.step()
    before = world.robots["thymio"].pose
    for _ in range(300):
        world.step()
        pose = world.robots["thymio"].pose
        assert math.dist((pose.x_m, pose.y_m), (before.x_m, before.y_m)) < 0.03
        before = pose


SILL_Y_M = -0.36
SILL = {"kind": "wall", "start_x_m": 0.3, "start_y_m": SILL_Y_M, "end_x_m": 0.7, "end_y_m": SILL_Y_M, "color": GRAY}
"""A wall so near to the end of the closed gate that no robot has room between them."""


@pytest.mark.parametrize("others", [0, 14], ids=["alone", "in a batch"])
@pytest.mark.parametrize(("move_s", "tick_m"), [(2.0, 0.005), (5.0, 0.002)])
@pytest.mark.parametrize("yaw_rad", [0.0, math.pi / 2, math.pi])
def test_a_door_waits_for_a_robot_between_it_and_a_wall(
    yaw_rad: float, move_s: float, tick_m: float, others: int
) -> None:
    """It was squeezed out sideways, or beyond the door."""
    batch = [{**ROBOT, "name": f"idle{place}", "x_m": -1.5 + 0.2 * place, "y_m": -1.5} for place in range(others)]
    opener = {**ROBOT, "name": "opener", "x_m": -0.5, "y_m": 0.34}
    world = World(make([FLOOR, {**GATE, "move_s": move_s}, PLATE, SILL], (ROBOT, opener, *batch)), noise=False)
    run(world, move_s)
    send(world, MoveRobot(0.5, -0.1, yaw_rad))
    leave(world)
    robot, seen = world.robots["thymio"], []
    for _ in range(700):
        world.step()
        seen.append(robot.pose)
    assert max(math.dist((one.x_m, one.y_m), (next_.x_m, next_.y_m)) for one, next_ in pairwise(seen)) < tick_m
    assert abs(robot.pose.x_m - 0.5) < 0.03
    ends = [robot.pose.place(point)[1] for point in robot_constants.hull()]
    assert min(ends) > SILL_Y_M + 0.01 - 0.001
    assert max(ends) < gate_y(world) - 0.3 + 0.001

    send(world, MoveRobot(1.5, 0.0, 0.0))
    run(world, move_s + 1.0)
    assert gate_y(world) == 0.0


def test_a_door_that_waits_opens_on_request() -> None:
    world = build(GATE, PLATE, SILL)
    enter(world)
    run(world, 2.5)
    send(world, MoveRobot(0.5, -0.1, 0.0))
    leave(world)
    run(world, 3.0)
    assert 0.05 < gate_y(world) < 0.07
    enter(world)
    run(world, 2.5)
    assert gate_y(world) == 0.6


def test_a_door_waits_for_an_object_and_for_the_robot_behind_it() -> None:
    crate = {"kind": "box", "name": "crate", "x_m": 1.0, "y_m": -0.08, "size_x_m": 0.06, "size_y_m": 0.06, **BOX}
    world = build(GATE, PLATE, SILL, {**crate, "mass_kg": 0.5})
    enter(world)
    run(world, 2.5)
    send(world, MoveRobot(0.5, -0.2, 0.0))
    world.post("crate", MoveObject(0.5, -0.08, 0.0))
    leave(world)
    run(world, 4.0)
    objects = {thing.name: thing.pose for thing in world.snapshot().objects}
    assert world.robots["thymio"].pose.y_m == pytest.approx(SILL_Y_M + 0.01 + 0.055, abs=0.005)
    assert objects["crate"].y_m == pytest.approx(SILL_Y_M + 0.01 + 0.11 + 0.03, abs=0.008)
    assert objects["gate"].y_m - 0.3 == pytest.approx(SILL_Y_M + 0.01 + 0.11 + 0.06, abs=0.01)
    send(world, MoveRobot(1.5, 0.0, 0.0))
    world.post("crate", MoveObject(1.0, -0.08, 0.0))
    run(world, 3.5)
    assert world.objects[1].pose.y_m == 0.0


def test_a_robot_that_leans_on_the_face_of_a_door_does_not_stop_it() -> None:
    world = build({**GATE, "size_y_m": 1.2}, PLATE)
    send(world, MoveRobot(0.4, 0.0, 0.0))
    send(world, MotorTargets(500, 500))
    run(world, 1.0)
    enter(world)
    run(world, 2.0)
    assert gate_y(world) == 0.6
