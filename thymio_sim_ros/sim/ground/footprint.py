"""Kernels: what the footprints of ground sensors see.

A sensor sees 9 x 9 samples (taps), 2.5 mm apart along the world's axes, weighted by a Gaussian of 4 mm
(docs/spec/thymio-robot.md section 7.2). Its position is rounded to a cell of half a pixel (0.5 mm). Cells belong to
tiles; the color of a tile that sees only one color is found once, so that most footprints need no tap.
"""

from __future__ import annotations

import math

from aseba_vm.kernel.record import Record
from aseba_vm.kernel.types import Floats, Ints, Words, kernel

__all__ = [
    "CELLS_PER_PIXEL",
    "MIXED",
    "TAPS",
    "TAP_STEP_M",
    "TILE_CELLS",
    "UNKNOWN",
    "Grid",
    "Spots",
    "Taps",
    "sample",
    "survey",
]

TAPS = 9
"""Taps along each axis."""
TAP_STEP_M = 0.0025
TAP_SIGMA_M = 0.004
CELLS_PER_PIXEL = 2
"""The step of the taps is a multiple of half a millimeter."""
TILE_CELLS = 64
"""Cells along the side of a tile: 32 mm at a pixel of 1 mm."""
UNKNOWN = -2
"""Value of a tile in place of a color number: not examined yet."""
MIXED = -1
"""Value of a tile in place of a color number: it sees more than one color."""

_TAPS = TAPS
_TILE_SHIFT = 6
_LAST_CELL = TILE_CELLS - 1
_ALL = 1.0 - 1e-9


class Spots(Record):
    """Positions and samples of footprints."""

    x: Floats
    """Position in the world's frame, m."""
    y: Floats
    reflectance: Floats
    """Mean reflectance 0…1 of the floor in the footprint."""
    floor: Floats
    """Part of the footprint that is floor, 0…1."""


class Taps(Record):
    """The taps along one axis; `column` and `row` are pixels of the present footprint."""

    offset: Floats
    """Offset from the middle, m."""
    weight: Floats
    column: Ints
    row: Ints


class Grid(Record):
    """Size and place of the raster and of its tiles; one element."""

    pixel: Floats
    """Side of a pixel, m."""
    rows: Ints
    columns: Ints
    origin_x: Ints
    """Column of the first pixel, counted from the world's origin; `origin_y` is its row."""
    origin_y: Ints
    tile_rows: Ints
    tile_columns: Ints
    tile_x: Ints
    """Column of the first tile, counted from the world's origin; `tile_y` is its row."""
    tile_y: Ints


@kernel
def _pixel(cell: int, offset: float, pixel_m: float, origin: int, size: int) -> int:
    """The pixel at an offset from the middle of a cell, clamped to one pixel around the raster."""
    found = math.floor(((cell + 0.5) * (pixel_m / CELLS_PER_PIXEL) + offset) / pixel_m) - origin
    return -1 if found < -1 else size if found > size else found


@kernel
def _color(grid: Grid, pixels: Words, row: int, column: int) -> int:
    """The color number of a pixel; 0, no floor, outside the raster."""
    if 0 <= row < grid.rows[0] and 0 <= column < grid.columns[0]:
        color: int = pixels[row * grid.columns[0] + column]
        return color
    return 0


@kernel
def _examine(grid: Grid, taps: Taps, pixels: Words, tile_x: int, tile_y: int) -> int:
    """The only color that a tile sees, or MIXED."""
    first = taps.offset[0]
    last = taps.offset[_TAPS - 1]
    pixel_m = grid.pixel[0]
    cell_x = tile_x << _TILE_SHIFT
    cell_y = tile_y << _TILE_SHIFT
    left = _pixel(cell_x, first, pixel_m, grid.origin_x[0], grid.columns[0])
    right = _pixel(cell_x + _LAST_CELL, last, pixel_m, grid.origin_x[0], grid.columns[0])
    bottom = _pixel(cell_y, first, pixel_m, grid.origin_y[0], grid.rows[0])
    top = _pixel(cell_y + _LAST_CELL, last, pixel_m, grid.origin_y[0], grid.rows[0])
    color = _color(grid, pixels, bottom, left)
    rows = grid.rows[0]
    columns = grid.columns[0]
    if color != 0 and (left < 0 or bottom < 0 or right >= columns or top >= rows):
        return MIXED
    # Outside the raster the color is 0, too.
    left = left if left > 0 else 0
    end = right + 1 if right < columns else columns
    for row in range(bottom if bottom > 0 else 0, top + 1 if top < rows else rows):
        for column in range(left, end):
            if pixels[row * columns + column] != color:
                return MIXED
    return color


@kernel
def survey(grid: Grid, taps: Taps, tiles: Ints, pixels: Words) -> None:
    """Find the only color of all tiles that are not examined yet."""
    for row in range(grid.tile_rows[0]):
        for column in range(grid.tile_columns[0]):
            tile = row * grid.tile_columns[0] + column
            if tiles[tile] == UNKNOWN:
                tiles[tile] = _examine(grid, taps, pixels, column + grid.tile_x[0], row + grid.tile_y[0])


@kernel
def sample(spots: Spots, count: Ints, grid: Grid, taps: Taps, tiles: Ints, pixels: Words, grays: Floats) -> None:
    """Write reflectance and part of floor of the first `count[0]` spots.

    Args:
        spots: positions, and results.
        count: one element.
        grid: sizes and places.
        taps: offsets and weights.
        tiles: the only color that each tile sees, MIXED or UNKNOWN, shape (tile rows, tile columns).
        pixels: color numbers of the ground, shape (rows, columns).
        grays: gray of each color number.
    """
    # Locals: WebAssembly reads an element of a record from memory each time.
    pixel_m = grid.pixel[0]
    cell_m = pixel_m / CELLS_PER_PIXEL
    rows = grid.rows[0]
    columns = grid.columns[0]
    for spot in range(count[0]):
        cell_x = math.floor(spots.x[spot] / cell_m)
        cell_y = math.floor(spots.y[spot] / cell_m)
        tile_x = (cell_x >> _TILE_SHIFT) - grid.tile_x[0]
        tile_y = (cell_y >> _TILE_SHIFT) - grid.tile_y[0]
        # Outside, the nearest tile is used: it is at the border, sees no floor, or is mixed and then sampled exactly.
        tile_x = 0 if tile_x < 0 else grid.tile_columns[0] - 1 if tile_x >= grid.tile_columns[0] else tile_x
        tile_y = 0 if tile_y < 0 else grid.tile_rows[0] - 1 if tile_y >= grid.tile_rows[0] else tile_y
        tile = tile_y * grid.tile_columns[0] + tile_x
        if tiles[tile] == UNKNOWN:
            tiles[tile] = _examine(grid, taps, pixels, tile_x + grid.tile_x[0], tile_y + grid.tile_y[0])
        color = tiles[tile]
        if color != MIXED:
            spots.reflectance[spot] = grays[color]
            spots.floor[spot] = 1.0 if color != 0 else 0.0
            continue
        for tap in range(_TAPS):
            taps.column[tap] = _pixel(cell_x, taps.offset[tap], pixel_m, grid.origin_x[0], columns)
            taps.row[tap] = _pixel(cell_y, taps.offset[tap], pixel_m, grid.origin_y[0], rows)
        # A Gaussian is separable: the weight of a tap is the product of the weights of its column and its row.
        gray = 0.0
        missing = 0.0
        for along in range(_TAPS):
            row = taps.row[along]
            gray_across = 0.0
            missing_across = 0.0
            for across in range(_TAPS):
                column = taps.column[across]
                color = 0
                if 0 <= row < rows and 0 <= column < columns:
                    color = pixels[row * columns + column]
                gray_across += taps.weight[across] * grays[color]
                if color == 0:
                    missing_across += taps.weight[across]
            gray += taps.weight[along] * gray_across
            missing += taps.weight[along] * missing_across
        # The gray is the mean over the floor in the footprint, not over all of it.
        floor = 1.0
        if missing > 0.0:
            floor = 1.0 - missing if missing < _ALL else 0.0
            gray = gray / floor if floor > 0.0 else 0.0
        spots.reflectance[spot] = gray
        spots.floor[spot] = floor
