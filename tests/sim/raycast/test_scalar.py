"""Rays against polygons and discs; pymunk's own ray casts are the oracle."""

from __future__ import annotations

import math
import random

import pymunk
import pytest

from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Box, Disc, Solid
from thymio_sim_ros.sim.raycast.scalar import ConvexObstacle, DiscObstacle, Surroundings, obstacle_of

SQUARE = ConvexObstacle(((1.0, -1.0), (3.0, -1.0), (3.0, 1.0), (1.0, 1.0)), 0.1)
DISC = DiscObstacle(2.0, 0.0, 1.0, 0.1)


@pytest.mark.parametrize("obstacle", [SQUARE, DISC])
def test_a_ray_meets_the_near_side(obstacle: ConvexObstacle | DiscObstacle) -> None:
    assert obstacle.distance(0.0, 0.0, 1.0, 0.0, 5.0) == pytest.approx(1.0)


@pytest.mark.parametrize("obstacle", [SQUARE, DISC])
@pytest.mark.parametrize(
    ("x", "y", "dx", "dy"),
    [(0.0, 0.0, -1.0, 0.0), (0.0, 1.5, 1.0, 0.0), (0.0, 0.0, 0.0, 1.0), (2.0, 0.0, 1.0, 0.0), (4.0, 0.0, 1.0, 0.0)],
)
def test_a_ray_that_points_away_passes_by_or_starts_inside_meets_nothing(
    obstacle: ConvexObstacle | DiscObstacle, x: float, y: float, dx: float, dy: float
) -> None:
    assert obstacle.distance(x, y, dx, dy, 5.0) == 5.0


@pytest.mark.parametrize("obstacle", [SQUARE, DISC])
def test_a_ray_that_is_too_short_meets_nothing(obstacle: ConvexObstacle | DiscObstacle) -> None:
    assert obstacle.distance(0.0, 0.0, 1.0, 0.0, 0.9) == 0.9


def test_a_fan_gives_the_nearest_obstacle_of_each_ray() -> None:
    around = Surroundings([SQUARE, DiscObstacle(0.7, 0.0, 0.1, 0.1)])
    slanted = (math.cos(0.5), math.sin(0.5))
    found = around.fan(0.0, 0.0, [(1.0, 0.0), slanted, (0.0, 1.0)], 2.0)
    assert found == pytest.approx((0.6, 1.0 / math.cos(0.5), math.inf))


def test_nothing_near_is_seen_at_once() -> None:
    assert Surroundings([]).is_empty
    assert Surroundings([SQUARE]).near(-5.0, 0.0, 2.0).is_empty
    assert Surroundings([SQUARE]).fan(-5.0, 0.0, [(1.0, 0.0)], 2.0) == (math.inf,)


def test_random_rays_agree_with_pymunk() -> None:
    dice = random.Random(1)
    for _ in range(300):
        pose = Pose(dice.uniform(-1, 1), dice.uniform(-1, 1), dice.uniform(-3, 3))
        outline = (
            Disc(dice.uniform(0.1, 0.5)) if dice.random() < 0.5 else Box(dice.uniform(0.1, 1), dice.uniform(0.1, 1))
        )
        solid = Solid("thing", pose, outline, 0.1, (0.0, 0.0, 0.0))
        x, y, angle = dice.uniform(-2, 2), dice.uniform(-2, 2), dice.uniform(-3, 3)
        dx, dy = math.cos(angle), math.sin(angle)
        space = pymunk.Space()
        shape: pymunk.Shape
        if isinstance(outline, Disc):
            shape = pymunk.Circle(space.static_body, outline.radius_m, (pose.x_m, pose.y_m))
        else:
            shape = pymunk.Poly(space.static_body, solid.vertices)
        space.add(shape)
        if shape.point_query((x, y)).distance <= 0.0:
            continue
        hit = space.segment_query_first((x, y), (x + 3 * dx, y + 3 * dy), 0.0, pymunk.ShapeFilter())
        expected = 3.0 if hit is None else 3.0 * hit.alpha
        assert obstacle_of(solid).distance(x, y, dx, dy, 3.0) == pytest.approx(expected, abs=1e-9)
