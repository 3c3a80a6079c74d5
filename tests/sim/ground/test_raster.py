"""Drawing on the ground: lines with round ends on floor, and taking them away again."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.sim.ground.pictures import picture_of
from thymio_sim_ros.sim.ground.raster import Picture
from thymio_sim_ros.sim.model.geometry import Point
from thymio_sim_ros.sim.model.primitives import Floor, Paint

WHITE, BLACK, RED, GREEN = (1.0, 1.0, 1.0), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)


def area(left: float, bottom: float, right: float, top: float) -> tuple[Point, ...]:
    return ((left, bottom), (right, bottom), (right, top), (left, top))


def sheet() -> Picture:
    """A white sheet of one square meter with a black square of 20 cm at its corner."""
    floor = Floor("sheet", area(0.0, 0.0, 1.0, 1.0), WHITE)
    return picture_of([floor], [Paint("square", area(0.0, 0.0, 0.2, 0.2), BLACK)])


def test_a_line_has_its_color_and_width() -> None:
    picture = sheet()
    picture.draw_segment(0.3, 0.5, 0.7, 0.5, 0.01, RED)
    red = [picture.color_at(0.5, 0.48 + step * 0.0005) == RED for step in range(80)]
    assert red.count(True) * 0.0005 == pytest.approx(0.01, abs=0.0011)
    assert picture.color_at(0.5, 0.5) == RED
    assert picture.color_at(0.5, 0.52) == WHITE


def test_its_ends_are_round() -> None:
    picture = sheet()
    picture.draw_segment(0.5, 0.5, 0.5, 0.5, 0.1, RED)
    red = sum(
        picture.color_at(0.4 + column * 0.001 + 0.0005, 0.4 + row * 0.001 + 0.0005) == RED
        for column in range(200)
        for row in range(200)
    )
    assert red * 1e-6 == pytest.approx(math.pi * 0.05**2, rel=0.01)


def test_a_hairline_is_a_pixel_wide_and_without_gaps() -> None:
    picture = sheet()
    picture.draw_segment(0.3, 0.3, 0.7, 0.61, 0.0, RED)
    columns = np.flatnonzero((picture.pixels == 3).any(axis=0))
    assert len(columns) == pytest.approx(401, abs=2)
    assert (np.diff(columns) == 1).all()


def test_the_changed_area_is_returned() -> None:
    left, bottom, right, top = sheet().draw_segment(0.3, 0.5, 0.4, 0.5, 0.01, RED) or (0, 0, 0, 0)
    assert (left, bottom) == pytest.approx((295, 495), abs=1)
    assert (right, top) == pytest.approx((405, 505), abs=1)


def test_nothing_is_drawn_where_there_is_no_floor() -> None:
    picture = sheet()
    picture.draw_segment(0.9, 0.5, 1.5, 0.5, 0.01, RED)
    assert picture.color_at(0.99, 0.5) == RED
    assert picture.color_at(1.01, 0.5) is None
    assert picture.draw_segment(2.0, 0.5, 3.0, 0.5, 0.01, RED) is None


def test_erasing_gives_back_floor_and_paint() -> None:
    picture = sheet()
    before = picture.pixels.copy()
    picture.draw_segment(0.1, 0.1, 0.5, 0.1, 0.02, RED)
    picture.draw_segment(0.1, 0.1, 0.5, 0.1, 0.01, GREEN)
    picture.draw_segment(0.1, 0.1, 0.5, 0.1, 0.02, None)
    assert (picture.pixels == before).all()


def test_erasing_a_part_leaves_the_rest() -> None:
    picture = sheet()
    picture.draw_segment(0.3, 0.5, 0.7, 0.5, 0.01, RED)
    picture.draw_segment(0.5, 0.4, 0.5, 0.6, 0.04, None)
    assert picture.color_at(0.4, 0.5) == RED
    assert picture.color_at(0.5, 0.5) == WHITE


def test_erasing_a_clean_sheet_changes_nothing() -> None:
    assert sheet().draw_segment(0.3, 0.5, 0.7, 0.5, 0.01, None) is None


def test_all_drawings_go_at_once() -> None:
    picture = sheet()
    before = picture.pixels.copy()
    assert not picture.restore()
    picture.draw_segment(0.1, 0.1, 0.5, 0.1, 0.02, RED)
    assert picture.restore()
    assert (picture.pixels == before).all()
