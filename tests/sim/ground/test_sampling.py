"""The painted ground under a sensor's footprint, against known answers."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.sim.images import printed
from thymio_sim_ros.sim.ground.sampling import Ground, GroundSample
from thymio_sim_ros.sim.model.geometry import Point, Pose
from thymio_sim_ros.sim.model.primitives import Floor, Paint
from thymio_sim_ros.sim.sensors.ground import response

WHITE, BLACK, RED = (1.0, 1.0, 1.0), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0)


def area(left: float, bottom: float, right: float, top: float) -> tuple[Point, ...]:
    return ((left, bottom), (right, bottom), (right, top), (left, top))


def floor(grey8: float, left: float, bottom: float, right: float, top: float) -> Floor:
    return Floor("floor", area(left, bottom, right, top), (grey8 / 255,) * 3)


def test_there_is_no_floor_outside_the_ground() -> None:
    ground = Ground([floor(255, 0.0, 0.0, 1.0, 1.0)], [])
    assert ground.sample(2.0, 0.5) == GroundSample(0.0, 0.0)
    assert ground.color_at(2.0, 0.5) is None
    assert ground.color_at(0.5, -0.5) is None


def test_a_world_without_ground_has_no_floor_anywhere() -> None:
    assert Ground([], []).sample(0.0, 0.0).floor == 0.0


def test_half_the_footprint_is_floor_at_an_edge() -> None:
    ground = Ground([floor(255, 0.0, 0.0, 1.0, 1.0)], [])
    inner, outer = ground.sample(0.9999, 0.5), ground.sample(1.0001, 0.5)
    assert inner.reflectance == pytest.approx(1.0)
    assert (inner.floor + outer.floor) / 2 == pytest.approx(0.5)


def test_the_count_falls_steadily_towards_an_edge() -> None:
    ground = Ground([floor(255, 0.0, 0.0, 1.0, 1.0)], [])
    samples = [ground.sample(0.98 + step * 0.001, 0.5) for step in range(40)]
    counts = [response(sample.reflectance, sample.floor) for sample in samples]
    assert counts == sorted(counts, reverse=True)
    assert (round(counts[0]), counts[-1]) == (938, 0.0)


def test_paint_covers_floor_and_later_paint_covers_earlier_paint() -> None:
    ground = Ground(
        [floor(255, -1.0, -1.0, 1.0, 1.0)],
        [Paint("a", area(-0.5, -0.5, 0.5, 0.5), BLACK), Paint("b", area(0.0, -0.1, 0.1, 0.1), RED)],
    )
    assert ground.color_at(0.8, 0.0) == WHITE
    assert ground.color_at(-0.3, 0.0) == BLACK
    assert ground.color_at(0.05, 0.0) == RED
    assert ground.sample(0.05, 0.0).reflectance == pytest.approx(1 / 3)


def test_paint_beyond_the_floor_makes_no_floor() -> None:
    ground = Ground([floor(255, 0.0, 0.0, 1.0, 1.0)], [Paint("a", area(0.5, 0.4, 2.0, 0.6), BLACK)])
    assert ground.color_at(0.99, 0.5) == BLACK
    assert ground.sample(1.2, 0.5).floor == 0.0


def test_a_tilted_strip_of_paint_is_as_wide_as_it_should_be() -> None:
    along = Pose(0.0, 0.0, math.radians(30))
    strip = Paint("a", along.place_all(area(-0.5, -0.02, 0.5, 0.02)), BLACK)
    ground = Ground([floor(255, -1.0, -1.0, 1.0, 1.0)], [strip])
    black = [ground.color_at(*along.place((0.1, step * 0.0005))) == BLACK for step in range(-60, 61)]
    assert black.count(True) * 0.0005 == pytest.approx(0.04, abs=0.0015)


def test_a_very_large_ground_gets_coarser_pixels() -> None:
    ground = Ground([floor(255, -100.0, -100.0, 100.0, 100.0)], [])
    assert ground.pixel_m == pytest.approx(0.04)
    assert ground.sample(50.0, 50.0) == GroundSample(1.0, 1.0)


def test_more_colors_than_the_palette_holds_fall_back_to_the_nearest_grey() -> None:
    paints = [Paint(f"p{i}", area(i * 0.01, 0.0, (i + 1) * 0.01, 0.1), (i / 400,) * 3) for i in range(400)]
    ground = Ground([floor(255, 0.0, 0.0, 4.0, 0.1)], paints)
    color = ground.color_at(3.995, 0.05)
    assert color is not None
    assert color[0] == pytest.approx(1.0, abs=0.01)


def test_a_drawing_is_seen_at_once_and_only_where_it_is() -> None:
    ground = Ground([floor(255, -1.0, -1.0, 1.0, 1.0)], [])
    places = [(x * 0.01, y * 0.01) for x in range(-20, 21) for y in range(-20, 21)]
    assert {ground.sample(*place) for place in places} == {GroundSample(1.0, 1.0)}
    ground.draw_segment(-0.05, 0.0, 0.05, 0.0, 0.04, BLACK)
    fresh = Ground([floor(255, -1.0, -1.0, 1.0, 1.0)], [])
    fresh.draw_segment(-0.05, 0.0, 0.05, 0.0, 0.04, BLACK)
    assert ground.sample(0.0, 0.0).reflectance == pytest.approx(0.0)
    assert [ground.sample(*place) for place in places] == [fresh.sample(*place) for place in places]


def test_an_erased_drawing_is_no_longer_seen() -> None:
    ground = Ground([floor(255, -1.0, -1.0, 1.0, 1.0)], [])
    ground.draw_segment(-0.05, 0.0, 0.05, 0.0, 0.04, BLACK)
    assert ground.sample(0.0, 0.0).reflectance == pytest.approx(0.0)
    ground.draw_segment(-0.05, 0.0, 0.05, 0.0, 0.05, None)
    assert ground.sample(0.0, 0.0) == GroundSample(1.0, 1.0)


def test_restoring_takes_all_drawings_away() -> None:
    ground = Ground([floor(255, -1.0, -1.0, 1.0, 1.0)], [])
    ground.draw_segment(-0.05, 0.0, 0.05, 0.0, 0.04, BLACK)
    ground.sample(0.0, 0.0)
    ground.restore()
    assert ground.sample(0.0, 0.0) == GroundSample(1.0, 1.0)
    assert ground.color_at(0.0, 0.0) == WHITE


def test_a_print_of_tiles_reads_as_floors_of_tiles() -> None:
    grays = [[37 * (3 * row + column) ** 2 % 256 for column in range(8)] for row in range(8)]
    floors = [
        floor(gray, column * 0.025, row * 0.025, (column + 1) * 0.025, (row + 1) * 0.025)
        for row, line in enumerate(grays)
        for column, gray in enumerate(line)
    ]
    rows = [[(gray, gray, gray, 255) for gray in line] for line in reversed(grays)]
    sheet = printed(rows, 0.2, 0.2, Pose(0.1, 0.1, 0.0))
    on_paper, tiled = Ground([floor(255, 0.0, 0.0, 0.2, 0.2)], [sheet]), Ground(floors, [])
    places = [(step * 0.0371 % 0.2, step * 0.0217 % 0.2) for step in range(200)]
    assert [on_paper.sample(*place).reflectance for place in places] == pytest.approx(
        [tiled.sample(*place).reflectance for place in places], abs=1e-9
    )


def test_many_footprints_at_once_see_what_each_sees_alone_also_after_drawing() -> None:
    alone, together = (Ground([floor(255, -0.5, -0.5, 0.5, 0.5)], []) for _ in range(2))
    places = np.random.default_rng(1).uniform(-0.6, 0.6, (2, 600))
    for step in range(3):
        reflectances, floors = np.zeros(600), np.zeros(600)
        together.sample_all(*places, reflectances, floors)
        found = [GroundSample(*pair) for pair in zip(reflectances.tolist(), floors.tolist(), strict=True)]
        assert found == [alone.sample(*place) for place in places.T.tolist()]
        for ground in (alone, together):
            ground.draw_segment(-0.4, 0.1 * step, 0.4, -0.2, 0.03, BLACK)
    assert len(set(found)) > 30
