"""Obstacles in frames of their own."""

from __future__ import annotations

import math

import pytest

from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.raycast.obstacle_table import BOX, DISC, HEIGHT, NOWHERE_M, ObstacleTable, polygon_in_frame
from thymio_sim_ros.sim.raycast.scalar import ConvexObstacle, DiscObstacle

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


def test_rows_tell_kinds() -> None:
    frames = ObstacleTable(
        [DiscObstacle(1.0, 2.0, 0.3, 0.1), ConvexObstacle(CORNERS, 0.2), ConvexObstacle(TRIANGLE, 0.3)]
    )
    assert frames.kinds.tolist() == [DISC, BOX, 0]
    assert frames.rows[:, HEIGHT].tolist() == [0.1, 0.2, 0.3]
    assert frames.rows[0].tolist() == [1.0, 2.0, 1.0, 0.0, 0.3, 0.3, 0.1]


def test_a_polygon_that_moves_keeps_its_number() -> None:
    frames = ObstacleTable([ConvexObstacle(TRIANGLE, 0.3)])
    for turn in range(3):
        frames.put(0, ConvexObstacle(Pose(0.0, 0.0, turn).place_all(TRIANGLE), 0.3))
    assert (frames.kinds.tolist(), len(frames.polygons)) == ([0], 1)


def test_what_is_gone_has_no_height_until_it_is_back() -> None:
    disc = DiscObstacle(1.0, 2.0, 0.3, 0.1)
    frames = ObstacleTable([disc])
    frames.put(0, None)
    assert frames.rows[0, HEIGHT] == NOWHERE_M
    frames.put(0, disc)
    assert frames.rows[0, HEIGHT] == 0.1
