"""Where floor is, and how far its edge."""

from __future__ import annotations

import math

import pytest

from tests.sim.builders import FLOOR, make
from thymio_sim_ros.sim.ground.floor_support import FloorSupport, nearest_floor


def test_a_playground_without_floors_has_no_edge() -> None:
    assert FloorSupport(()).clearance_m(3.0, 4.0) == math.inf


def test_clearance_is_the_way_to_the_nearest_edge() -> None:
    floor_support = FloorSupport(make([FLOOR]).floors)
    assert floor_support.clearance_m(0.0, 0.5) == pytest.approx(1.5)
    assert floor_support.clearance_m(1.9, 0.0) == pytest.approx(0.1)
    assert floor_support.clearance_m(2.1, 0.0) < 0.0
    assert floor_support.clearance_m(9.0, 0.0) < 0.0


def test_the_nearest_floor_of_a_point_outside() -> None:
    tile = {"kind": "rectangle", "size_x_m": 1.0, "size_y_m": 1.0, "color": "#ffffff"}
    floors = make([{**tile, "name": "left", "x_m": -2.0}, {**tile, "name": "right", "x_m": 2.0}], []).floors
    for point, name, place in (
        ((9.0, 0.2), "right", (2.5, 0.2)),
        ((9.0, 9.0), "right", (2.5, 0.5)),
        ((-0.1, -7.0), "left", (-1.5, -0.5)),
    ):
        floor, nearest = nearest_floor(floors, point)
        assert (floor.name, nearest) == (name, pytest.approx(place))


def test_floors_that_touch_leave_no_gap() -> None:
    tile = {"kind": "rectangle", "size_x_m": 1.0, "size_y_m": 1.0, "color": "#ffffff"}
    floor_support = FloorSupport(make([{**tile, "x_m": 0.5}, {**tile, "x_m": -0.5}], []).floors)
    assert floor_support.clearance_m(0.0, 0.0) == pytest.approx(0.0)
    assert floor_support.clearance_m(0.2, 0.0) == pytest.approx(0.2)
