"""The grid for path planners: floors are free, walls and the rest are not."""

from __future__ import annotations

import math

import pytest

from thymio_sim_ros.sim.ground.occupancy import MOST_CELLS, grid
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Box, Disc, Floor, Solid

WHITE = (1.0, 1.0, 1.0)
FLOOR = Floor("ground", ((-0.1, -0.05), (0.1, -0.05), (0.1, 0.05), (-0.1, 0.05)), WHITE)


def shown(found):
    rows = [found.occupied[begin : begin + found.columns] for begin in range(0, len(found.occupied), found.columns)]
    return ["".join("#" if cell else "." for cell in row) for row in reversed(rows)]


def test_a_floor_is_free():
    found = grid([FLOOR], [])
    assert (found.columns, found.rows, found.cell_m) == (20, 10, 0.01)
    assert found.corner == pytest.approx((-0.1, -0.05))
    assert shown(found) == ["." * 20] * 10


def test_walls_and_posts_are_occupied():
    wall = Solid("wall", Pose(0.05, 0.0, math.pi / 2), Box(0.0999, 0.0199), 0.1, WHITE)
    post = Solid("post", Pose(-0.07, 0.0, 0.0), Disc(0.02), 0.1, WHITE)
    found = grid([FLOOR], [wall, post])
    assert shown(found) == [
        "..............##....",
        "..............##....",
        "..............##....",
        "..##..........##....",
        ".####.........##....",
        ".####.........##....",
        "..##..........##....",
        "..............##....",
        "..............##....",
        "..............##....",
    ]


def test_where_there_is_no_floor_one_cannot_go():
    right = Floor("right", ((0.1, 0.0), (0.2, 0.0), (0.2, 0.05), (0.1, 0.05)), WHITE)
    rows = shown(grid([FLOOR, right], []))
    assert rows[0] == "." * 30
    assert rows[-1] == "." * 20 + "#" * 10


def test_a_large_playground_has_larger_cells():
    floor = Floor("ground", ((0.0, 0.0), (100.0, 0.0), (100.0, 1.0), (0.0, 1.0)), WHITE)
    found = grid([floor], [])
    assert (found.columns, found.rows) == (MOST_CELLS, 20)


def test_nothing_has_no_cells():
    assert grid([], []).occupied == ()
