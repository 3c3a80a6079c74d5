"""For how long a robot can reach nothing; pictures of it with known distances."""

from __future__ import annotations

import math
from collections.abc import Iterable

import pymunk
from thymio_sim_ros.sim.physics.time_to_contact import MAX_TICK_DISTANCE_M, SAFETY_MARGIN_M, ticks_to_contact

from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Box, Disc, Load, Solid
from thymio_sim_ros.sim.physics import MovableBody, RobotBody
from thymio_sim_ros.sim.raycast.broadphase import Broadphase, Mover
from thymio_sim_ros.sim.raycast.scalar import obstacle_of

GRAY = (0.5, 0.5, 0.5)
ROBOT = RobotBody("robot", Pose(0.0, 0.0, 1.0))
REACH_M = robot_constants.HULL_RADIUS_M + SAFETY_MARGIN_M


def ticks(
    solids: Iterable[Solid] = (), movers: Iterable[Mover] = (), *, at_least: int = 1, is_alone: bool = False
) -> int:
    broadphase = Broadphase(obstacle_of(solid) for solid in solids)
    broadphase.replace_movers([ROBOT, *movers])
    return ticks_to_contact(ROBOT, broadphase, at_least=at_least, is_alone=is_alone)


def wall(away_m: float) -> Solid:
    return Solid("wall", Pose(REACH_M + away_m + 0.01, 0.0, 0.0), Box(0.02, 1.0), 0.1, GRAY)


def thing(away_m: float) -> MovableBody:
    solid = Solid("thing", Pose(REACH_M + away_m + 0.03, 0.0, 0.0), Disc(0.03), 0.1, GRAY, Load(0.1, 0.3, 0.02))
    return MovableBody(solid, pymunk.Body(body_type=pymunk.Body.STATIC), set())


def test_a_wall_is_as_far_as_a_robot_can_go() -> None:
    assert ticks([wall(20.5 * MAX_TICK_DISTANCE_M)]) == 20
    assert ticks([wall(0.5 * MAX_TICK_DISTANCE_M)]) == 0


def test_fewer_ticks_than_asked_for_are_none() -> None:
    assert ticks([wall(20.5 * MAX_TICK_DISTANCE_M)], at_least=20) == 20
    assert ticks([wall(20.5 * MAX_TICK_DISTANCE_M)], at_least=21) == 0


def test_two_robots_share_the_distance() -> None:
    other = RobotBody(
        "other", Pose(0.0, robot_constants.HULL_RADIUS_M + REACH_M + 20.5 * MAX_TICK_DISTANCE_M, -math.pi / 2)
    )
    assert ticks(movers=[other]) == 10


def test_an_object_that_no_other_robot_can_push_rests_and_another_may_come_twice_as_fast() -> None:
    assert ticks(movers=[thing(30.5 * MAX_TICK_DISTANCE_M)], is_alone=True) == 30
    assert ticks(movers=[thing(30.5 * MAX_TICK_DISTANCE_M)]) == 10


def test_far_from_everything_it_looks_again_after_about_a_second() -> None:
    assert ticks() in (99, 100)
