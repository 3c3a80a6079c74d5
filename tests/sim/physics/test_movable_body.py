"""Things that can be pushed: how far they go, what stops them, who sees them."""

from __future__ import annotations

import math
from typing import Any

import pymunk
import pytest

from tests.sim.builders import FLOOR, GRAY, ROBOT, box, make, measure_one, run, send
from thymio_sim_ros.sim.commands import MotorTargets
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.physics import MovableBody
from thymio_sim_ros.sim.world import World

FRONT_M = 0.08


def crate(x_m: float, y_m: float = 0.0, mass_kg: float = 0.1, **fields: Any) -> dict[str, Any]:
    """A movable box of 6 cm."""
    return {**box(x_m, y_m, 0.06, 0.06), "name": "crate", "mass_kg": mass_kg, **fields}


def can(x_m: float, y_m: float = 0.0, mass_kg: float = 0.1, **fields: Any) -> dict[str, Any]:
    """A movable cylinder of 3 cm radius."""
    place = {"x_m": x_m, "y_m": y_m, "radius_m": 0.03, "height_m": 0.1, "color": GRAY}
    return {"kind": "cylinder", "name": "can", **place, "mass_kg": mass_kg, **fields}


def quiet(*shapes: dict[str, Any], robots: tuple[dict[str, Any], ...] = (ROBOT,)) -> World:
    return World(make([FLOOR, *shapes], robots), noise=False)


def place_of(world: World, name: str) -> Pose:
    return next(thing.pose for thing in world.snapshot().objects if thing.name == name)


def test_an_object_that_was_pushed_away_is_met_where_it_is() -> None:
    other = {**ROBOT, "name": "other", "x_m": 0.6, "y_m": 0.6, "yaw_rad": -math.pi / 2}
    world = quiet(crate(0.2), robots=(ROBOT, other))
    for robot, speed, seconds in (("thymio", 500, 3.0), ("thymio", -500, 2.5), ("other", 500, 3.5)):
        world.post(robot, MotorTargets(speed, speed))
        run(world, seconds)
        world.post(robot, MotorTargets(0, 0))
    assert place_of(world, "crate").x_m == pytest.approx(0.6, abs=0.05)
    assert place_of(world, "crate").y_m < -0.05


@pytest.mark.parametrize(("height_m", "is_seen"), [(0.03, False), (0.1, True)])
def test_proximity_sensors_look_over_a_low_object(height_m: float, is_seen: bool) -> None:
    assert any(measure_one(quiet(crate(0.15, height_m=height_m)), "proximity").words) == is_seen


def test_an_object_that_turns_on_the_spot_is_not_at_rest() -> None:
    (solid,) = (solid for solid in make([FLOOR, crate(0.5)]).solids if solid.load is not None)
    thing = MovableBody(solid, pymunk.Body(body_type=pymunk.Body.STATIC), set())
    for spin, is_moving in ((1.0, True), (1e-9, False)):
        thing.body.angular_velocity = spin
        thing.end_tick(0.5, 0.0, 0.1, 0.0, 0.0, spin)
        assert (thing.is_moving, thing.body.angular_velocity) == (is_moving, spin if is_moving else 0.0)


@pytest.mark.parametrize("thing", [crate(0.2), can(0.2)], ids=lambda thing: thing["name"])
def test_a_light_object_is_pushed_before_the_robot(thing: dict[str, Any]) -> None:
    world = quiet(thing)
    send(world, MotorTargets(300, 300))
    run(world, 4.0)
    robot, pose = world.robots["thymio"].pose, place_of(world, thing["name"])
    assert pose.x_m == pytest.approx(robot.x_m + FRONT_M + 0.03, abs=0.004)
    assert (pose.y_m, robot.y_m) == pytest.approx((0.0, 0.0), abs=0.003)


def test_pushing_costs_speed_in_proportion_to_the_friction() -> None:
    def way(mass_kg: float) -> float:
        world = quiet(crate(0.112, mass_kg=mass_kg))
        send(world, MotorTargets(500, 500))
        run(world, 3.0)
        return world.robots["thymio"].pose.x_m

    lost = [3.0 * 0.166 - way(mass_kg) for mass_kg in (0.1, 0.2, 0.4)]
    assert lost[1] == pytest.approx(2 * lost[0], rel=0.1)
    assert lost[2] == pytest.approx(4 * lost[0], rel=0.1)
    assert lost[2] == pytest.approx(3.0 * 0.25 * 0.4 * 9.81 / 27, rel=0.1)


def test_a_heavy_object_stalls_the_robot_and_stays_where_it_is() -> None:
    world = quiet(crate(0.2, mass_kg=1.5))
    send(world, MotorTargets(500, 500))
    run(world, 8.0)
    assert place_of(world, "crate").x_m == pytest.approx(0.2, abs=0.002)
    assert world.robots["thymio"].pose.x_m == pytest.approx(0.2 - 0.03 - FRONT_M, abs=0.003)
    assert world.robots["thymio"].wheels.speeds_m_s == pytest.approx((0.0, 0.0), abs=1e-3)


def test_an_object_slides_on_by_its_speed_and_friction_when_the_robot_stops() -> None:
    world = quiet(crate(0.112, friction=0.02, restitution=0.0))
    send(world, MotorTargets(500, 500))
    run(world, 1.0)
    send(world, MotorTargets(0, 0))
    before = place_of(world, "crate").x_m
    run(world, 2.0)
    speed = 0.166 - 0.02 * 0.1 * 9.81 / 27
    assert place_of(world, "crate").x_m - before == pytest.approx(speed**2 / (2 * 0.02 * 9.81), rel=0.05)


def test_an_object_comes_to_rest_exactly() -> None:
    world = quiet(crate(0.15, 0.02))
    send(world, MotorTargets(400, 400))
    run(world, 2.0)
    send(world, MotorTargets(-400, -400))
    run(world, 0.5)
    rest = place_of(world, "crate")
    run(world, 2.0)
    assert place_of(world, "crate") == rest


def test_a_push_beside_the_middle_turns_a_box() -> None:
    world = quiet(crate(0.15, 0.03))
    send(world, MotorTargets(300, 300))
    run(world, 2.0)
    assert place_of(world, "crate").yaw_rad > 0.1


def test_objects_push_objects_and_a_wall_stops_them_all() -> None:
    world = quiet(crate(0.15), {**crate(0.25), "name": "other"}, box(0.6, 0.0, 0.02, 1.0))
    send(world, MotorTargets(300, 300))
    run(world, 8.0)
    assert place_of(world, "other").x_m == pytest.approx(0.59 - 0.03, abs=0.002)
    assert place_of(world, "crate").x_m == pytest.approx(0.59 - 0.09, abs=0.003)
    assert world.robots["thymio"].pose.x_m == pytest.approx(0.59 - 0.12 - FRONT_M, abs=0.003)


def test_a_robot_never_jumps_through_an_object_as_in_the_reference() -> None:
    for thing in (can(0.14), crate(0.14), can(0.14, mass_kg=2.0), can(0.14, 0.02, mass_kg=2.0)):
        world = quiet(thing)
        send(world, MotorTargets(500, 500))
        before = world.robots["thymio"].pose
        for _ in range(400):
            world.step()
            pose = world.robots["thymio"].pose
            assert math.dist((pose.x_m, pose.y_m), (before.x_m, before.y_m)) < 0.004
            before = pose


def test_rays_see_an_object_where_it_is_now() -> None:
    world = quiet(can(0.12, mass_kg=0.05), box(0.9, 0.0, 0.1, 1.0))
    before = measure_one(world, "proximity").words[2]
    send(world, MotorTargets(500, 500))
    run(world, 2.0)
    pushed = measure_one(world, "proximity").words[2]
    send(world, MotorTargets(-500, -500))
    run(world, 1.5)
    assert (before > 4000, pushed > 4000, measure_one(world, "proximity").words[2]) == (True, True, 0)


def test_an_object_that_moved_or_fell_is_reported_once() -> None:
    world = quiet(crate(0.5), can(-0.5))
    physics = world._physics
    one, other = physics.movable_obstacles()
    assert physics.moved_obstacles() == {}
    first, second = physics.movables.values()
    physics.place(second, Pose(-0.6, 0.1, 0.0))
    assert physics.moved_obstacles() == {1: second.obstacle}
    assert (first.obstacle, second.obstacle is other) == (one, False)
    physics.drop_movable(first)
    assert physics.moved_obstacles() == {0: None}
    assert physics.moved_obstacles() == {}


def test_the_contact_names_the_object() -> None:
    world = quiet(crate(0.15))
    send(world, MotorTargets(300, 300))
    contacts = [contact for step in run(world, 1.0) for contact in step.contacts]
    assert {contact.other for contact in contacts} == {"crate"}


def test_mirrored_worlds_push_mirrored() -> None:
    def go(sign: int) -> tuple[Pose, Pose]:
        world = quiet(crate(0.15, sign * 0.02, yaw_rad=sign * 0.3))
        send(world, MotorTargets(300, 280) if sign > 0 else MotorTargets(280, 300))
        run(world, 3.0)
        return world.robots["thymio"].pose, place_of(world, "crate")

    for one, other in zip(go(1), go(-1), strict=True):
        assert (one.x_m, one.y_m, one.yaw_rad) == pytest.approx((other.x_m, -other.y_m, -other.yaw_rad), abs=1e-3)


def test_gliding_does_not_pass_by_an_object_at_rest() -> None:
    world = quiet(crate(1.0))
    send(world, MotorTargets(500, 500))
    run(world, 8.0)
    assert place_of(world, "crate").x_m == pytest.approx(world.robots["thymio"].pose.x_m + FRONT_M + 0.03, abs=0.004)


def test_reset_puts_objects_back() -> None:
    world = quiet(crate(0.15))
    send(world, MotorTargets(300, 300))
    run(world, 2.0)
    world.reset()
    assert place_of(world, "crate") == Pose(0.15, 0.0, 0.0)


def test_an_object_that_slides_loses_a_hundredth_of_its_speed_each_second_beside_its_friction() -> None:
    friction, drag = 0.0025, 0.01
    world = quiet(crate(0.16, friction=friction, restitution=0.81))
    send(world, MotorTargets(500, 500))
    run(world, 0.5)
    send(world, MotorTargets(0, 0))
    run(world, 0.1)
    first = place_of(world, "crate").x_m
    run(world, 1.0)
    second = place_of(world, "crate").x_m
    speed = second - first  # in the middle of that second
    run(world, 4.0)
    third = place_of(world, "crate").x_m
    run(world, 1.0)
    slower = place_of(world, "crate").x_m - third  # five seconds later
    brake = friction * 9.81
    expected = (speed + brake / drag) * math.exp(-5 * drag) - brake / drag
    assert slower == pytest.approx(expected, abs=1e-5)
    assert slower < speed - 5 * brake - 0.004
