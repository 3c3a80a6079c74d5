"""Who may reach something soon; distances between outlines are the oracle."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence

import numpy as np
import pytest
from thymio_sim_ros.sim.physics.broadphase_batch import CHECK_INTERVAL_TICKS, BroadphaseBatch
from thymio_sim_ros.sim.physics.time_to_contact import MAX_TICK_DISTANCE_M

from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Box, Disc, Polygon, Solid
from thymio_sim_ros.sim.raycast.scalar import obstacle_of

WAY_M = CHECK_INTERVAL_TICKS * MAX_TICK_DISTANCE_M
LOOSE_M = 0.05
"""A robot nearer than this to a fixed outline, beside its way, may be reported as near; farther it is not."""
TRIANGLE = Polygon(((0.0, 0.0), (0.1, 0.0), (0.0, 0.08)))
Place = tuple[float, float, float]


def distance_m(outline: list[tuple[float, float]], x: float, y: float) -> float:
    """Of a point from a closed line; 0 inside of a convex one."""
    sides = list(zip(outline, outline[1:] + outline[:1], strict=True))
    if all((bx - ax) * (y - ay) - (by - ay) * (x - ax) >= 0.0 for (ax, ay), (bx, by) in sides):
        return 0.0
    found = math.inf
    for (ax, ay), (bx, by) in sides:
        dx, dy = bx - ax, by - ay
        share = max(0.0, min(1.0, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy)))
        found = min(found, math.hypot(ax + share * dx - x, ay + share * dy - y))
    return found


def gap_m(one: list[tuple[float, float]], other: list[tuple[float, float]]) -> float:
    """Between two convex outlines that do not overlap."""
    return min(min(distance_m(other, *corner) for corner in one), min(distance_m(one, *corner) for corner in other))


def look(
    broadphase: BroadphaseBatch, places: list[Place], things: Sequence[Place] = (), fallen: int = -1
) -> list[bool]:
    stands = np.arange(len(places)) != fallen
    found: list[bool] = broadphase.near(
        np.array(places).reshape(-1, 3).T, stands, np.array(things).reshape(-1, 3).T
    ).tolist()
    return found


@pytest.mark.parametrize("seed", range(8))
def test_all_robots_that_can_reach_something_are_found_and_few_others(seed: int) -> None:
    dice = random.Random(seed)
    outlines = [Box(dice.uniform(0.01, 1.0), dice.uniform(0.01, 0.2)), Disc(0.05), TRIANGLE, Box(0.05, 0.08)]
    fixed = [
        Solid(
            f"{index}",
            Pose(dice.uniform(-1.4, 1.4), dice.uniform(-1.4, 1.4), dice.uniform(-3, 3)),
            outline,
            0.1,
            (0, 0, 0),
        )
        for index, outline in enumerate(outlines)
    ]
    places = [(dice.uniform(-1.4, 1.4), dice.uniform(-1.4, 1.4), dice.uniform(-3, 3)) for _ in range(20)]
    things = [(dice.uniform(-1.4, 1.4), dice.uniform(-1.4, 1.4), dice.uniform(0.01, 0.05)) for _ in range(5)]
    found = look(BroadphaseBatch([obstacle_of(solid) for solid in fixed]), places, things)
    hulls = [list(Pose(*place).place_all(robot_constants.hull())) for place in places]
    for index, hull in enumerate(hulls):
        spare = []
        for solid in fixed:
            if isinstance(solid.outline, Disc):
                away_m = distance_m(hull, solid.pose.x_m, solid.pose.y_m) - solid.outline.radius_m
            else:
                away_m = gap_m(hull, list(solid.pose.place_all(solid.outline.vertices)))
            spare.append(away_m - WAY_M)
        spare += [distance_m(hull, x, y) - reach_m - 3 * WAY_M for x, y, reach_m in things]
        spare += [gap_m(hull, other) - 2 * WAY_M for other in hulls if other is not hull]
        if min(spare) <= 0.0:
            assert found[index]
        elif min(spare) > LOOSE_M:
            assert not found[index]


def test_two_robots_are_near_each_other_when_both_can_come_closer() -> None:
    broadphase = BroadphaseBatch([])
    for gap, expected in ((2 * WAY_M - 0.001, True), (2 * WAY_M + 0.02, False)):
        places = [(0.0, 0.0, 0.0), (2 * robot_constants.HULL_RADIUS_M + gap, 0.0, math.pi)]
        assert look(broadphase, places) == [expected, expected]


@pytest.mark.parametrize("is_compiled", [None, False])
def test_a_fallen_robot_is_near_nothing(is_compiled: bool | None) -> None:
    places = [(0.0, 0.0, 0.0), (0.17, 0.0, math.pi), (5.0, 0.0, 0.0)]
    post = obstacle_of(Solid("post", Pose(0.17, 0.0, 0.0), Disc(0.02), 0.1, (0, 0, 0)))
    for fixed in ([], [post]):
        broadphase = BroadphaseBatch(fixed, is_compiled=is_compiled)
        assert look(broadphase, places) == [True, True, False]
        assert look(broadphase, places, fallen=1) == [False, False, False]


def test_a_robot_alone_in_an_empty_world_is_near_nothing() -> None:
    assert look(BroadphaseBatch([]), [(0.0, 0.0, 0.0)]) == [False]
    assert look(BroadphaseBatch([]), []) == []
