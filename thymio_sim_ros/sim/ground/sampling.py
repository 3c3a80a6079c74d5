"""The ground under a sensor: a raster of floors, paint and drawings, and what a footprint sees of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.ground import footprint
from thymio_sim_ros.sim.ground.footprint import (
    CELLS_PER_PIXEL,
    TAP_STEP_M,
    TAPS,
    TILE_CELLS,
    UNKNOWN,
    Grid,
    Spots,
    Taps,
)
from thymio_sim_ros.sim.ground.raster import Area, Picture, grid_of
from thymio_sim_ros.sim.kernel.memory import KernelMemory
from thymio_sim_ros.sim.model.primitives import Color, Floor, Mark

__all__ = ["NO_FLOOR", "Ground", "GroundSample"]

_SPOTS = 256
"""Footprints that are sampled at once."""
_MANY = 32
"""With more footprints than this, all tiles are examined before the first measurement; else each when it is met."""
_TILE_PIXELS = TILE_CELLS // CELLS_PER_PIXEL

Values = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class GroundSample:
    """The ground in a footprint: mean reflectance 0…1 of its floor, and the fraction of it that is floor, 0…1."""

    reflectance: float
    floor: float


NO_FLOOR = GroundSample(0.0, 0.0)


class Ground:
    """Reflectance and color of the ground. Invariant: only `draw_segment`, `paint` and `restore` change it."""

    def __init__(self, floors: Sequence[Floor], paints: Sequence[Mark]) -> None:
        """Rasterize the ground: later floors lie on earlier ones, paints on floors, later ones on earlier ones."""
        pixel_m, (origin_x, origin_y), (height, width) = grid_of(floors)
        # The tiles reach one tile beyond the raster, where footprints see its border.
        self._corner = (origin_x // _TILE_PIXELS - 1, origin_y // _TILE_PIXELS - 1)
        tiles = (height // _TILE_PIXELS + 4, width // _TILE_PIXELS + 4)
        memory = KernelMemory(
            sum((Spots.size(_SPOTS), Taps.size(TAPS), Grid.size(1), KernelMemory.room(1, "int32")))
            + KernelMemory.room(tiles, "int32")
            + KernelMemory.room((height, width), "uint16")
            + KernelMemory.room(Picture.COLORS, "float64")
        )
        self._spots, taps, grid = Spots(memory, _SPOTS), Taps(memory, TAPS), Grid(memory, 1)
        self._count = memory.array(1, "int32")
        self._tiles = memory.array(tiles, "int32")
        self._tiles[:] = UNKNOWN
        self._picture = Picture(
            floors, paints, memory.array((height, width), "uint16"), memory.array(Picture.COLORS, "float64")
        )
        taps.offset[:] = (np.arange(TAPS) - TAPS // 2) * TAP_STEP_M
        weights = np.exp(-(taps.offset**2) / (2 * footprint.TAP_SIGMA_M**2))
        taps.weight[:] = weights / weights.sum()
        grid.pixel[0] = pixel_m
        grid.rows[0], grid.columns[0] = height, width
        grid.origin_x[0], grid.origin_y[0] = origin_x, origin_y
        grid.tile_rows[0], grid.tile_columns[0] = tiles
        grid.tile_x[0], grid.tile_y[0] = self._corner
        self._survey = memory.bind(footprint.survey, grid, taps, self._tiles, self._picture.pixels)
        self._is_surveyed = False
        self._sample = memory.bind(
            footprint.sample, self._spots, self._count, grid, taps, self._tiles, self._picture.pixels,
            self._picture.grays,
        )  # fmt: skip

    @property
    def pixel_m(self) -> float:
        """Side of a pixel in m: 1 mm, or more for a very large ground."""
        return self._picture.pixel_m

    def sample(self, x_m: float, y_m: float) -> GroundSample:
        """The sample of the footprint of a sensor at this position in the world's frame."""
        spots = self._spots.view
        spots.x[0], spots.y[0], self._count[0] = x_m, y_m, 1
        self._sample()
        return GroundSample(spots.reflectance[0], spots.floor[0])

    def sample_all(self, xs_m: Values, ys_m: Values, reflectances: Values, floors: Values) -> None:
        """Write what footprints at many positions see; all arrays have the same shape (footprints,)."""
        if len(xs_m) > _MANY and not self._is_surveyed:
            self._survey()
            self._is_surveyed = True
        spots = self._spots
        for first in range(0, len(xs_m), _SPOTS):
            part = slice(first, first + _SPOTS)
            count = len(xs_m[part])
            spots.x[:count], spots.y[:count], self._count[0] = xs_m[part], ys_m[part], count
            self._sample()
            reflectances[part], floors[part] = spots.reflectance[:count], spots.floor[:count]

    def color_at(self, x_m: float, y_m: float) -> Color | None:
        """The color at a point, or None where there is no floor."""
        return self._picture.color_at(x_m, y_m)

    def draw_segment(
        self, x0_m: float, y0_m: float, x1_m: float, y1_m: float, width_m: float, color: Color | None
    ) -> None:
        """Draw a line with round ends on the floor; None as color erases what was drawn there.

        Positions and width are in m in the world's frame. Sensors see it from their next reading on.
        """
        area = self._picture.draw_segment(x0_m, y0_m, x1_m, y1_m, width_m, color)
        if area is not None:
            self._forget(area)

    def restore(self) -> None:
        """Erase everything that was drawn."""
        if self._picture.restore():
            self._tiles[:] = UNKNOWN

    def paint(self, color: Color | None) -> None:
        """Give the first floor another color, or its own with None."""
        if self._picture.paint(color):
            self._tiles[:] = UNKNOWN

    def _forget(self, area: Area) -> None:
        """Mark the tiles with a footprint that reaches into an area of the raster as not examined."""
        reach = math.ceil(TAPS // 2 * TAP_STEP_M / self.pixel_m) + 1
        left, bottom, right, top = area
        origin_x, origin_y = self._picture.origin
        columns = (((x + origin_x) // _TILE_PIXELS - self._corner[0]) for x in (left - reach, right + reach))
        rows = (((y + origin_y) // _TILE_PIXELS - self._corner[1]) for y in (bottom - reach, top + reach))
        (first_column, last_column), (first_row, last_row) = columns, rows
        self._tiles[max(0, first_row) : last_row + 1, max(0, first_column) : last_column + 1] = UNKNOWN
