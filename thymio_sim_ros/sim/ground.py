"""The painted ground: a picture of floors and paint, and what a ground sensor sees of it.

The picture has one pixel for each square of `pixel_m` (1 mm unless the ground is very large), aligned with
the world's origin. A sensor sees 9 x 9 samples, 2.5 mm apart along the world's axes, weighted by a
Gaussian of 4 mm (thymio-robot.md section 7.2). Since samples lie on half millimetres, the picture is
blurred once for every half millimetre; this is done tile by tile, when a sensor first comes near.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.geometry import Point
from thymio_sim_ros.sim.primitives import Color, Floor, Paint

__all__ = ["Ground", "GroundSample"]

_PIXEL_M = 0.001
_MAX_PIXELS = 25_000_000
_MAX_COLORS = 254
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
    """Reflectance and color of the ground. Invariant: the picture does not change (yet: a pen will)."""

    def __init__(self, floors: Sequence[Floor], paints: Sequence[Paint]) -> None:
        corners = [vertex for floor in floors for vertex in floor.vertices] or [(0.0, 0.0)]
        low_x, low_y = (min(corner[axis] for corner in corners) for axis in (0, 1))
        high_x, high_y = (max(corner[axis] for corner in corners) for axis in (0, 1))
        self.pixel_m = max(_PIXEL_M, math.sqrt((high_x - low_x) * (high_y - low_y) / _MAX_PIXELS))
        self._origin = (math.floor(low_x / self.pixel_m), math.floor(low_y / self.pixel_m))
        width = math.ceil(high_x / self.pixel_m) - self._origin[0] + 1
        height = math.ceil(high_y / self.pixel_m) - self._origin[1] + 1
        self._picture = np.zeros((height, width), dtype=np.uint8)
        self._palette: list[Color] = [(0.0, 0.0, 0.0)]
        for floor in floors:
            self._fill(floor.vertices, floor.color, everywhere=True)
        for paint in paints:
            self._fill(paint.vertices, paint.color, everywhere=False)
        self._greys = np.array([sum(color) / 3 for color in self._palette])
        self._cell_m = self.pixel_m / _CELLS_PER_PIXEL
        steps = (np.arange(_TAPS) - _TAPS // 2) * _TAP_STEP_M
        weights = np.exp(-(steps**2) / (2 * _TAP_SIGMA_M**2))
        self._weights = weights / weights.sum()
        self._tiles: dict[tuple[int, int], tuple[_Values, _Values] | GroundSample] = {}

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
        column = math.floor(x_m / self.pixel_m) - self._origin[0]
        row = math.floor(y_m / self.pixel_m) - self._origin[1]
        height, width = self._picture.shape
        if not (0 <= column < width and 0 <= row < height):
            return None
        index = int(self._picture[row, column])
        return self._palette[index] if index else None

    def _fill(self, vertices: Sequence[Point], color: Color, *, everywhere: bool) -> None:
        """Paint the pixels whose centre lies in a convex polygon; without `everywhere` only those that are floor."""
        index = self._index(color)
        xs = [x / self.pixel_m - self._origin[0] for x, _ in vertices]
        ys = [y / self.pixel_m - self._origin[1] for _, y in vertices]
        height, width = self._picture.shape
        bottom, top = max(0, math.floor(min(ys))), min(height, math.ceil(max(ys)) + 1)
        row = np.arange(bottom, top) + 0.5
        left, right = np.full(len(row), min(xs)), np.full(len(row), max(xs))
        outside = np.zeros(len(row), dtype=bool)
        for this in range(len(xs)):
            ax, ay, bx, by = xs[this - 1], ys[this - 1], xs[this], ys[this]
            if by == ay:
                outside |= (bx - ax) * (row - ay) < 0
                continue
            crossing = ax + (bx - ax) * (row - ay) / (by - ay)
            if by > ay:
                right = np.minimum(right, crossing)
            else:
                left = np.maximum(left, crossing)
        first = np.maximum(0, np.ceil(left - 0.5)).astype(int)
        last = np.minimum(width, np.floor(right - 0.5) + 1).astype(int)
        for line in np.flatnonzero((first < last) & ~outside).tolist():
            pixels = self._picture[bottom + line, first[line] : last[line]]
            if everywhere:
                pixels[:] = index
            else:
                pixels[pixels > 0] = index

    def _index(self, color: Color) -> int:
        """The palette's index of a color; when the palette is full, of the nearest grey in it."""
        if color in self._palette[1:]:
            return self._palette.index(color, 1)
        if len(self._palette) <= _MAX_COLORS:
            self._palette.append(color)
            return len(self._palette) - 1
        grey = sum(color)
        return min(range(1, len(self._palette)), key=lambda index: abs(sum(self._palette[index]) - grey))

    def _blur(self, tile_x: int, tile_y: int) -> tuple[_Values, _Values] | GroundSample:
        """One tile of samples; a single one when the tile sees one color only."""
        columns = self._taps(tile_x, self._origin[0], self._picture.shape[1])
        rows = self._taps(tile_y, self._origin[1], self._picture.shape[0])
        first_row, last_row = int(rows.min()), int(rows.max())
        first_column, last_column = int(columns.min()), int(columns.max())
        seen = self._padded(first_row, last_row + 1, first_column, last_column + 1)
        if (seen == seen[0, 0]).all():
            return GroundSample(float(self._greys[seen[0, 0]]), 1.0) if seen[0, 0] else NO_FLOOR
        rows, columns = rows - first_row, columns - first_column
        grey = self._weigh(self._greys[seen], rows, columns)
        floor = self._weigh((seen > 0).astype(float), rows, columns)
        mean = np.divide(grey, floor, out=np.zeros_like(grey), where=floor > 0)
        return mean, floor

    def _taps(self, tile: int, origin: int, size: int) -> npt.NDArray[np.intp]:
        """Pixel of each cell of a tile along one axis and of each tap, kept one pixel round the picture."""
        cells = tile * _TILE_CELLS + np.arange(_TILE_CELLS) + 0.5
        places = cells[:, None] * self._cell_m + (np.arange(_TAPS) - _TAPS // 2)[None, :] * _TAP_STEP_M
        pixels = np.floor(places / self.pixel_m).astype(np.intp) - origin
        return np.clip(pixels, -1, size)

    def _padded(self, top: int, bottom: int, left: int, right: int) -> npt.NDArray[np.uint8]:
        """A part of the picture, without floor where it reaches beyond."""
        height, width = self._picture.shape
        part = np.zeros((bottom - top, right - left), dtype=np.uint8)
        y0, y1, x0, x1 = max(top, 0), min(bottom, height), max(left, 0), min(right, width)
        if y0 < y1 and x0 < x1:
            part[y0 - top : y1 - top, x0 - left : x1 - left] = self._picture[y0:y1, x0:x1]
        return part

    def _weigh(self, values: _Values, rows: npt.NDArray[np.intp], columns: npt.NDArray[np.intp]) -> _Values:
        """The weighted mean over the taps: along the columns, then along the rows."""
        across = np.einsum("rct,t->rc", values[:, columns], self._weights)
        blurred: _Values = np.einsum("rtc,t->rc", across[rows], self._weights)
        return blurred
