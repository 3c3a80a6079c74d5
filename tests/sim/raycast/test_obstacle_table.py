"""Obstacles in frames of their own."""

from __future__ import annotations

import math

import pytest

from thymio_sim_ros.sim.kernel.memory import KernelMemory
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.raycast.obstacle_table import (
    BOX,
    DISC,
    NOWHERE_M,
    POLYGON,
    ObstacleTable,
    polygon_in_frame,
)
from thymio_sim_ros.sim.raycast.scalar import ConvexObstacle, DiscObstacle, Obstacle

CORNERS = ((-0.2, -0.1), (0.2, -0.1), (0.2, 0.1), (-0.2, 0.1))
TRIANGLE = ((0.0, 0.0), (2.0, 0.0), (0.0, 1.0))


def test_a_turned_box_is_its_middle_heading_and_half_size() -> None:
    pose = Pose(1.0, 2.0, 0.7)
    place, planes = polygon_in_frame(pose.place_all(CORNERS))
    assert planes is None
    assert place == pytest.approx((1.0, 2.0, math.cos(0.7), math.sin(0.7), 0.2, 0.1))


def test_any_other_polygon_has_a_half_plane_for_each_side() -> None:
    place, planes = polygon_in_frame(Pose(1.0, 0.0, math.pi / 2).place_all(TRIANGLE))
    assert place == pytest.approx((0.5, 1.0, 0.0, 1.0, 1.0, 0.5))
    assert planes is not None
    slope = (1.0 / math.sqrt(5.0), 2.0 / math.sqrt(5.0), 0.0)
    assert planes.tolist() == [pytest.approx(side) for side in ((0.0, -1.0, 0.5), slope, (-1.0, 0.0, 1.0))]


def test_a_trapezoid_is_no_box() -> None:
    assert polygon_in_frame(((0.0, 0.0), (2.0, 0.0), (1.5, 1.0), (0.0, 1.0)))[1] is not None


def table(*obstacles: Obstacle) -> ObstacleTable:
    return ObstacleTable(KernelMemory(1 << 16), (), obstacles, 0)


def test_rows_have_kind_frame_and_height() -> None:
    rows = table(
        DiscObstacle(1.0, 2.0, 0.3, 0.1), ConvexObstacle(CORNERS, 0.2), ConvexObstacle(TRIANGLE, 0.3)
    ).obstacles
    assert rows.kind.tolist() == [DISC, BOX, POLYGON]
    assert rows.height.tolist() == [0.1, 0.2, 0.3]
    frame = (rows.x, rows.y, rows.cosine, rows.sine, rows.half_x, rows.half_y)
    assert [column[0] for column in frame] == [1.0, 2.0, 1.0, 0.0, 0.3, 0.3]


def test_a_polygon_that_moves_keeps_its_half_planes() -> None:
    found = table(ConvexObstacle(TRIANGLE, 0.3))
    planes = found.obstacles.first_plane[0], found.obstacles.last_plane[0]
    normals = found.planes.normal_x[slice(*planes)].tolist()
    for turn in range(3):
        found.put(0, ConvexObstacle(Pose(0.0, 0.0, turn).place_all(TRIANGLE), 0.3))
    assert (found.obstacles.first_plane[0], found.obstacles.last_plane[0]) == planes
    assert planes[1] - planes[0] == 3
    assert found.planes.normal_x[slice(*planes)].tolist() == normals


def test_what_is_gone_has_no_height_until_it_is_back() -> None:
    disc = DiscObstacle(1.0, 2.0, 0.3, 0.1)
    found = table(disc)
    for obstacle, height_m in ((None, NOWHERE_M), (disc, 0.1)):
        found.put(0, obstacle)
        assert found.obstacles.height[0] == height_m
