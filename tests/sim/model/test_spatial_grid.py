"""The grid in which things lie by place."""

from __future__ import annotations

from thymio_sim_ros.sim.model.spatial_grid import SpatialGrid, cell_of


def test_a_place_on_a_border_belongs_to_the_square_above_it() -> None:
    assert (cell_of(0.49, -0.01), cell_of(0.5, 0.0)) == ((0, -1), (1, 0))


def test_an_object_is_found_wherever_its_bounds_touch_and_once() -> None:
    squares: SpatialGrid[str] = SpatialGrid()
    squares.add("beam", (0.1, 0.1, 2.4, 0.2))
    squares.add("dot", (3.0, 3.0, 3.1, 3.1))
    assert list(squares.near((0.0, 0.0, 0.9, 0.4))) == ["beam"]
    assert list(squares.near((2.3, 0.1, 2.3, 0.1))) == ["beam"]
    assert list(squares.near((1.0, 1.0, 1.2, 1.2))) == []
    assert list(squares.near((-9.0, -9.0, 9.0, 9.0))) == ["beam", "dot"]


def test_what_is_larger_than_the_world_is_found_everywhere() -> None:
    squares: SpatialGrid[str] = SpatialGrid()
    squares.add("sky", (-1e6, -1e6, 1e6, 1e6))
    assert list(squares.near((5.0, 5.0, 5.0, 5.0))) == ["sky"]
