"""The ground under a sensor: a picture of floors, paint and drawings, and what a footprint sees of it.

A sensor sees 9 x 9 samples, 2.5 mm apart along the world's axes, weighted by a Gaussian of 4 mm (thymio-robot.md
section 7.2). Since samples lie on half millimetres, the picture is blurred once for every half millimetre; this is
done tile by tile, when a sensor first comes near. Drawing forgets the tiles that see it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.picture import Area, Picture
from thymio_sim_ros.sim.primitives import Color, Floor, Mark

__all__ = ["Ground", "GroundSample"]

_TAPS = 9
_TAP_STEP_M = 0.0025
_TAP_SIGMA_M = 0.004
_CELLS_PER_PIXEL = 2
"""Blurred values per pixel: the samples' step is a multiple of half a millimetre."""
_TILE_CELLS = 64
_MAX_TILES = 1024
"""Blurred tiles that are kept at once: at most 64 MB."""

_Values = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class GroundSample:
    """What a footprint sees: mean reflectance 0…1 of the floor in it, and which part of it is floor, 0…1."""

    reflectance: float
    floor: float


NO_FLOOR = GroundSample(0.0, 0.0)


class Ground:
    """Reflectance and color of the ground. Invariant: only `draw_segment` and `restore` change it."""

    def __init__(self, floors: Sequence[Floor], paints: Sequence[Mark]) -> None:
        self._picture = Picture(floors, paints)
        self._cell_m = self._picture.pixel_m / _CELLS_PER_PIXEL
        steps = (np.arange(_TAPS) - _TAPS // 2) * _TAP_STEP_M
        weights = np.exp(-(steps**2) / (2 * _TAP_SIGMA_M**2))
        self._weights: list[float] = (weights / weights.sum()).tolist()
        self._tiles: dict[tuple[int, int], tuple[_Values, _Values] | GroundSample] = {}

    @property
    def pixel_m(self) -> float:
        """How fine the picture is: 1 mm, or more for a very large ground."""
        return self._picture.pixel_m

    def sample(self, x_m: float, y_m: float) -> GroundSample:
        """What a sensor's footprint centred here sees."""
        cell_x, cell_y = math.floor(x_m / self._cell_m), math.floor(y_m / self._cell_m)
        key = (cell_x // _TILE_CELLS, cell_y // _TILE_CELLS)
        tile = self._tiles.get(key)
        if tile is None:
            tile = self._blur(*key)
            if len(self._tiles) >= _MAX_TILES:
                self._tiles.clear()
            self._tiles[key] = tile
        if isinstance(tile, GroundSample):
            return tile
        place = (cell_y % _TILE_CELLS, cell_x % _TILE_CELLS)
        return GroundSample(tile[0].item(place), tile[1].item(place))

    def color_at(self, x_m: float, y_m: float) -> Color | None:
        """The color of a place, or None where there is no floor."""
        return self._picture.color_at(x_m, y_m)

    def draw_segment(
        self, x0_m: float, y0_m: float, x1_m: float, y1_m: float, width_m: float, color: Color | None
    ) -> None:
        """Draw a line with round ends, metres in the world's frame; with None as color take drawings away there.

        Sensors see it from their next reading on. Where there is no floor nothing is drawn.
        """
        area = self._picture.draw_segment(x0_m, y0_m, x1_m, y1_m, width_m, color)
        if area is not None:
            for key in self._tiles_that_see(area):
                self._tiles.pop(key, None)

    def restore(self) -> None:
        """Take away all that was drawn."""
        if self._picture.restore():
            self._tiles.clear()

    def _tiles_that_see(self, area: Area) -> list[tuple[int, int]]:
        """Tiles with a footprint that reaches into an area of the picture."""
        reach = math.ceil(_TAPS // 2 * _TAP_STEP_M / self.pixel_m) + 1
        size = _TILE_CELLS // _CELLS_PER_PIXEL
        origin_x, origin_y = self._picture.origin
        left, bottom = (area[0] - reach + origin_x) // size, (area[1] - reach + origin_y) // size
        right, top = (area[2] + reach + origin_x) // size, (area[3] + reach + origin_y) // size
        return [(x, y) for y in range(bottom, top + 1) for x in range(left, right + 1)]

    def _blur(self, tile_x: int, tile_y: int) -> tuple[_Values, _Values] | GroundSample:
        """One tile of samples; a single one when the tile sees one color only."""
        height, width = self._picture.pixels.shape
        columns = self._taps(tile_x, self._picture.origin[0], width)
        rows = self._taps(tile_y, self._picture.origin[1], height)
        first_row, last_row = int(rows.min()), int(rows.max())
        first_column, last_column = int(columns.min()), int(columns.max())
        seen = self._picture.padded(first_row, last_row + 1, first_column, last_column + 1)
        if (seen == seen[0, 0]).all():
            return GroundSample(float(self._picture.greys[seen[0, 0]]), 1.0) if seen[0, 0] else NO_FLOOR
        rows, columns = rows - first_row, columns - first_column
        grey = self._weigh(self._picture.greys[seen], rows, columns)
        if seen.all():
            return grey, np.ones_like(grey)
        return _over_floor(grey, self._weigh((seen == 0).astype(float), rows, columns))

    def _taps(self, tile: int, origin: int, size: int) -> npt.NDArray[np.intp]:
        """Pixel of each cell of a tile along one axis and of each tap, kept one pixel round the picture."""
        cells = tile * _TILE_CELLS + np.arange(_TILE_CELLS) + 0.5
        places = cells[:, None] * self._cell_m + (np.arange(_TAPS) - _TAPS // 2)[None, :] * _TAP_STEP_M
        pixels = np.floor(places / self.pixel_m).astype(np.intp) - origin
        return np.clip(pixels, -1, size)

    def _weigh(self, values: _Values, rows: npt.NDArray[np.intp], columns: npt.NDArray[np.intp]) -> _Values:
        """The weighted mean over the taps, summed in their order: along the columns, then along the rows."""
        across = self._weights[0] * values.take(columns[:, 0], axis=1)
        for tap in range(1, _TAPS):
            across += self._weights[tap] * values.take(columns[:, tap], axis=1)
        blurred: _Values = self._weights[0] * across.take(rows[:, 0], axis=0)
        for tap in range(1, _TAPS):
            blurred += self._weights[tap] * across.take(rows[:, tap], axis=0)
        return blurred


def _over_floor(grey: _Values, missing: _Values) -> tuple[_Values, _Values]:
    """Mean grey of the floor and which part is floor, where a part of the footprint is missing."""
    floor = np.where(missing < 1.0 - 1e-9, 1.0 - missing, 0.0)
    return np.divide(grey, floor, out=np.zeros_like(grey), where=floor > 0.0), floor
