"""Pictures for viewers without textures: few rectangles that look like them."""

from __future__ import annotations

import numpy as np
import pytest

from tests.sim.images import BLACK, CLEAR, RED, WHITE, pixels
from thymio_sim_ros.sim.formats.image_io import Pixels
from thymio_sim_ros.sim.ground.rect_tiling import Tile, mosaic


def test_equal_neighbours_in_a_row_are_one_tile() -> None:
    tiles = mosaic(pixels([[WHITE, WHITE, BLACK, BLACK], [RED, RED, RED, RED]]))
    assert tiles == [
        Tile(0.0, 0.5, 0.5, 1.0, (1.0, 1.0, 1.0, 1.0)),
        Tile(0.5, 0.5, 1.0, 1.0, (0.0, 0.0, 0.0, 1.0)),
        Tile(0.0, 0.0, 1.0, 0.5, (1.0, 0.0, 0.0, 1.0)),
    ]


def test_what_is_clear_is_left_out() -> None:
    assert [tile.left for tile in mosaic(pixels([[CLEAR, WHITE]]))] == [0.5]


def test_an_image_full_of_details_gets_coarser() -> None:
    noise = np.random.default_rng(1).integers(0, 256, (500, 500, 4)).astype(np.uint8)
    tiles = mosaic(Pixels(500, 500, noise.tobytes()))
    assert 1000 < len(tiles) <= 4000
    assert max(tile.top for tile in tiles) == pytest.approx(1.0)


@pytest.mark.parametrize("most", [-1, 1, 2, 50, 5000])
def test_the_number_of_tiles_can_be_limited_further(most: int) -> None:
    noise = np.random.default_rng(1).integers(1, 256, (300, 300, 4)).astype(np.uint8)
    assert 1 <= len(mosaic(Pixels(300, 300, noise.tobytes()), most=most)) <= max(1, min(most, 4000))
