"""Kernel: what footprints on the ground see, computed as in `Ground.sample_under`, operation by operation."""

from __future__ import annotations

import math

from aseba_vm.kernel.types import Floats, Ints, Words, kernel

__all__ = ["COUNTS", "TAPS", "sample", "spots"]

TAPS = 9
COUNTS = (
    "places", "tile_shift", "tile_rows", "tile_columns", "first_tile_x", "first_tile_y", "rows", "columns", "origin_x",
    "origin_y", "is_unknown",
)  # fmt: skip
"""Meaning of each element of `counts`; the last is a result."""
(
    _PLACES, _SHIFT, _TILE_ROWS, _TILE_COLUMNS, _TILE_X, _TILE_Y, _ROWS, _COLUMNS, _ORIGIN_X, _ORIGIN_Y, _IS_UNKNOWN,
) = range(len(COUNTS))  # fmt: skip
_CELL, _PIXEL, _STEPS, _WEIGHTS = 0, 1, 2, 2 + TAPS
"""Indices in `sizes`: size of a cell and of a pixel in m, offsets of the taps in m, weights of the taps."""
_UNKNOWN, _MIXED = -2, -1
_ALL = 1.0 - 1e-9
_TAPS = TAPS


@kernel
def spots(robots: int, count: int, poses: Floats, turns: Floats, points: Floats, xs: Floats, ys: Floats) -> None:
    """Transform points of the robots' frames to the world; `turns` are cosines, then sines, of the robots' yaws."""
    for robot in range(robots):
        cos = turns[robot]
        sin = turns[robots + robot]
        for point in range(count):
            along = points[2 * point]
            aside = points[2 * point + 1]
            xs[robot * count + point] = poses[3 * robot] + cos * along - sin * aside
            ys[robot * count + point] = poses[3 * robot + 1] + sin * along + cos * aside


@kernel
def taps(cell: int, origin: int, size: int, sizes: Floats, found: Ints, first: int) -> None:
    """Write the pixel of each tap of a cell along one axis, clamped to one pixel around the raster."""
    middle = (cell + 0.5) * sizes[_CELL]
    for tap in range(_TAPS):
        pixel = math.floor((middle + sizes[_STEPS + tap]) / sizes[_PIXEL]) - origin
        found[first + tap] = -1 if pixel < -1 else size if pixel > size else pixel


@kernel
def sample(
    counts: Ints,
    sizes: Floats,
    xs: Floats,
    ys: Floats,
    tiles: Ints,
    pixels: Words,
    grays: Floats,
    near: Ints,
    reflectances: Floats,
    floors: Floats,
) -> None:
    """Write reflectance and part of floor at every place; stop with `is_unknown` at an unknown tile.

    Args:
        counts: see `COUNTS`.
        sizes: see the indices above.
        xs: x of the places in the world's frame in m; `ys`: y.
        tiles: the only color that each tile sees, _MIXED or _UNKNOWN, shape (tile rows, tile columns).
        pixels: color numbers of the ground, shape (rows, columns).
        grays: gray of each color number.
        near: scratch memory: columns, then rows of the taps of one place.
        reflectances: result, shape (places,), 0…1; `floors`: part of the footprint that is floor, 0…1.
    """
    width = counts[_COLUMNS]
    height = counts[_ROWS]
    counts[_IS_UNKNOWN] = 0
    for place in range(counts[_PLACES]):
        cell_x = math.floor(xs[place] / sizes[_CELL])
        cell_y = math.floor(ys[place] / sizes[_CELL])
        column = (cell_x >> counts[_SHIFT]) - counts[_TILE_X]
        row = (cell_y >> counts[_SHIFT]) - counts[_TILE_Y]
        # outside of the tiles the nearest one is used: it sees no floor, or is mixed and then sampled exactly
        column = 0 if column < 0 else counts[_TILE_COLUMNS] - 1 if column >= counts[_TILE_COLUMNS] else column
        row = 0 if row < 0 else counts[_TILE_ROWS] - 1 if row >= counts[_TILE_ROWS] else row
        color = tiles[row * counts[_TILE_COLUMNS] + column]
        if color == _UNKNOWN:
            counts[_IS_UNKNOWN] = 1
            return
        if color != _MIXED:
            reflectances[place] = grays[color]
            floors[place] = 1.0 if color != 0 else 0.0
            continue
        taps(cell_x, counts[_ORIGIN_X], width, sizes, near, 0)
        taps(cell_y, counts[_ORIGIN_Y], height, sizes, near, _TAPS)
        # A Gaussian is separable: the weight of a tap is the product of the weights of its column and its row.
        gray = 0.0
        missing = 0.0
        for along in range(_TAPS):
            row = near[_TAPS + along]
            grey_across = 0.0
            missing_across = 0.0
            for across in range(_TAPS):
                column = near[across]
                color = 0
                if 0 <= row < height and 0 <= column < width:
                    color = pixels[row * width + column]
                grey_across += sizes[_WEIGHTS + across] * grays[color]
                if color == 0:
                    missing_across += sizes[_WEIGHTS + across]
            gray += sizes[_WEIGHTS + along] * grey_across
            missing += sizes[_WEIGHTS + along] * missing_across
        # The gray is the mean over the floor in the footprint, not over all of it.
        floor = 1.0
        if missing > 0.0:
            floor = 1.0 - missing if missing < _ALL else 0.0
            gray = gray / floor if floor > 0.0 else 0.0
        reflectances[place] = gray
        floors[place] = floor
