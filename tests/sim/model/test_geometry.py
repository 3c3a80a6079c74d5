"""Poses, and overlap of convex outlines."""

from __future__ import annotations

import math

import pytest

from thymio_sim_ros.sim.model.geometry import Pose, convex_hulls_overlap, disc_overlaps_hull, is_convex, wrap_angle

SQUARE = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))


def moved(by: float) -> list[tuple[float, float]]:
    return [(x + by, y) for x, y in SQUARE]


def test_a_pose_turns_counter_clockwise_and_then_shifts() -> None:
    assert Pose(1.0, 2.0, math.pi / 2).place((1.0, 0.0)) == pytest.approx((1.0, 3.0))


def test_a_pose_places_many_points_as_it_places_one() -> None:
    pose = Pose(0.3, -0.2, 1.1)
    assert pose.place_all(SQUARE) == tuple(pose.place(point) for point in SQUARE)


@pytest.mark.parametrize(("angle", "expected"), [(0.0, 0.0), (3 * math.pi / 2, -math.pi / 2), (-7.0, -7.0 + math.tau)])
def test_an_angle_is_wrapped_to_half_a_turn_each_way(angle: float, expected: float) -> None:
    assert wrap_angle(angle) == pytest.approx(expected)


@pytest.mark.parametrize(("by", "overlap"), [(0.0, True), (0.99, True), (1.0, False), (1.01, False), (-1.01, False)])
def test_hulls_overlap_when_they_share_more_than_an_edge(by: float, overlap: bool) -> None:
    assert convex_hulls_overlap(SQUARE, moved(by)) is overlap
    assert convex_hulls_overlap(moved(by), SQUARE) is overlap


@pytest.mark.parametrize(
    ("center", "overlap"),
    [((0.5, 0.5), True), ((1.4, 0.5), True), ((1.6, 0.5), False), ((1.3, 1.3), True), ((1.4, 1.4), False)],
)
def test_a_disc_overlaps_a_hull_inside_at_edges_and_at_corners(center: tuple[float, float], overlap: bool) -> None:
    assert disc_overlaps_hull(center, 0.5, SQUARE) is overlap


def test_convex_means_counter_clockwise_without_dents() -> None:
    assert is_convex(SQUARE)
    assert not is_convex(SQUARE[::-1])
    assert not is_convex(((0.0, 0.0), (1.0, 0.0), (0.4, 0.4), (0.0, 1.0)))
