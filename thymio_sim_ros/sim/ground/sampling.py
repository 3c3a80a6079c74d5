"""The ground under a sensor: a raster of floors, paint and drawings, and what a footprint sees of it.

A sensor sees 9 x 9 samples (taps), 2.5 mm apart along the world's axes, weighted by a Gaussian of 4 mm
(docs/spec/thymio-robot.md section 7.2). The position of a sensor is rounded to a cell of half a pixel (0.5 mm), so the
footprints of all positions are the raster blurred once for each cell. One robot blurs tile by tile, when a sensor first
comes near (`sample`). A batch computes single footprints, but only in tiles that see more than one color
(`sample_under`). Drawing invalidates the tiles that see it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.ground.raster import Area, Picture
from thymio_sim_ros.sim.kernel.footprint_binding import FootprintBinding
from thymio_sim_ros.sim.kernel.footprint_kernel import TAPS as _TAPS
from thymio_sim_ros.sim.kernel.memory import is_available
from thymio_sim_ros.sim.model.primitives import Color, Floor, Mark

__all__ = ["Ground", "GroundSample"]

_TAP_STEP_M = 0.0025
_TAP_SIGMA_M = 0.004
_CELLS_PER_PIXEL = 2
"""Blurred values per pixel: the samples' step is a multiple of half a millimeter."""
_TILE_SHIFT = 6
_TILE_CELLS = 1 << _TILE_SHIFT
"""Cells along the side of a tile: 32 mm at a pixel of 1 mm."""
_MAX_TILES = 1024
"""Blurred tiles that are kept at once: at most 64 MB."""

_UNKNOWN, _MIXED = -2, -1
"""Values of a tile in place of a color number: not examined yet; sees more than one color."""
_MANY = 16
"""If more tiles than this are unknown, all tiles are examined at once, which is faster for each."""

_Values = npt.NDArray[np.float64]
_Indices = npt.NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class GroundSample:
    """What a footprint sees: mean reflectance 0…1 of the floor in it, and which part of it is floor, 0…1."""

    reflectance: float
    floor: float


NO_FLOOR = GroundSample(0.0, 0.0)


class Ground:
    """Reflectance and color of the ground. Invariant: only `draw_segment` and `restore` change it."""

    def __init__(self, floors: Sequence[Floor], paints: Sequence[Mark], *, is_compiled: bool | None = None) -> None:
        """Rasterize the ground.

        Args:
            floors: where there is floor, later ones on earlier ones.
            paints: markings on the floor, later ones on earlier ones.
            is_compiled: whether batches use a kernel or numpy; None: a kernel if available. The results are the same.
        """
        self._is_compiled = is_available() if is_compiled is None else is_compiled
        self._footprint_binding: FootprintBinding | None = None
        self._picture = Picture(floors, paints)
        self._cell_m = self._picture.pixel_m / _CELLS_PER_PIXEL
        steps = (np.arange(_TAPS) - _TAPS // 2) * _TAP_STEP_M
        weights = np.exp(-(steps**2) / (2 * _TAP_SIGMA_M**2))
        self._weights: list[float] = (weights / weights.sum()).tolist()
        self._tiles: dict[tuple[int, int], tuple[_Values, _Values] | GroundSample] = {}
        size = _TILE_CELLS // _CELLS_PER_PIXEL
        height, width = self._picture.pixels.shape
        self._corner = (self._picture.origin[0] // size - 1, self._picture.origin[1] // size - 1)
        self._plain = np.full((height // size + 4, width // size + 4), _UNKNOWN, dtype=np.int32)
        """The only color that each tile sees, _MIXED or _UNKNOWN, shape (tile rows, tile columns). The first one is the
        tile at `_corner`; positions outside use the nearest tile, which is at the border of the ground."""

    @property
    def pixel_m(self) -> float:
        """Side of a pixel in m: 1 mm, or more for a very large ground."""
        return self._picture.pixel_m

    def sample(self, x_m: float, y_m: float) -> GroundSample:
        """Return what the footprint of a sensor at this position in the world's frame sees."""
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

    def sample_under(self, poses: _Values, points: _Values) -> tuple[_Values, _Values]:
        """Do the same as `sample` for sensors of many robots, with the same bits.

        Args:
            poses: x, y, yaw of the robots in the world's frame, shape (robots, 3).
            points: x, y of the sensors in the robot's frame, shape (points, 2).

        Returns:
            Reflectances and parts of floor, 0…1, shape (robots, points) each.
        """
        if self._is_compiled:
            found = self._sampled(poses, points)
            if found is not None:
                return found
        x, y, yaw = poses.T[:, :, None]
        cos, sin = np.cos(yaw), np.sin(yaw)
        xs = x + cos * points[:, 0] - sin * points[:, 1]
        ys = y + sin * points[:, 0] + cos * points[:, 1]
        reflectance, floor = self._sample_all(xs.ravel(), ys.ravel())
        return reflectance.reshape(xs.shape), floor.reshape(xs.shape)

    def color_at(self, x_m: float, y_m: float) -> Color | None:
        """Return the color at a point, or None where there is no floor."""
        return self._picture.color_at(x_m, y_m)

    def draw_segment(
        self, x0_m: float, y0_m: float, x1_m: float, y1_m: float, width_m: float, color: Color | None
    ) -> None:
        """Draw a line with round ends on the floor; None as color erases what was drawn there.

        Positions and width are in m in the world's frame. Sensors see it from their next reading on.
        """
        area = self._picture.draw_segment(x0_m, y0_m, x1_m, y1_m, width_m, color)
        if area is not None:
            for key in self._tiles_that_see(area):
                self._tiles.pop(key, None)
                column, row = key[0] - self._corner[0], key[1] - self._corner[1]
                if 0 <= row < self._plain.shape[0] and 0 <= column < self._plain.shape[1]:
                    self._plain[row, column] = _UNKNOWN

    def restore(self) -> None:
        """Erase everything that was drawn."""
        if self._picture.restore():
            self._tiles.clear()
            self._plain[:] = _UNKNOWN

    def _sample_all(self, x_m: _Values, y_m: _Values) -> tuple[_Values, _Values]:
        """Sample at many positions with numpy, shape (positions,)."""
        cells_x = np.floor(x_m / self._cell_m).astype(np.intp)
        cells_y = np.floor(y_m / self._cell_m).astype(np.intp)
        colors = self._plain_colors(cells_x // _TILE_CELLS, cells_y // _TILE_CELLS)
        reflectance, floor = self._picture.grays[colors], (colors != 0).astype(float)
        mixed = (colors == _MIXED).nonzero()[0]
        if len(mixed):
            height, width = self._picture.pixels.shape
            columns = self._taps(cells_x[mixed], self._picture.origin[0], width)
            rows = self._taps(cells_y[mixed], self._picture.origin[1], height)
            reflectance[mixed], floor[mixed] = self._footprints(rows, columns)
        return reflectance, floor

    def _sampled(self, poses: _Values, points: _Values) -> tuple[_Values, _Values] | None:
        """Sample by the kernel; None if there are unknown tiles, which the numpy path then examines."""
        if self._footprint_binding is None or not self._footprint_binding.is_for(len(poses), points):
            picture = self._picture
            steps = (np.arange(_TAPS) - _TAPS // 2) * _TAP_STEP_M
            self._footprint_binding = FootprintBinding(
                len(poses),
                points,
                picture.pixels,
                self._plain,
                picture.grays,
                (self._cell_m, picture.pixel_m, *steps.tolist(), *self._weights),
                (_TILE_SHIFT, *self._plain.shape, *self._corner, *picture.pixels.shape, *picture.origin),
            )
            picture.move_to(self._footprint_binding.pixels, self._footprint_binding.grays)
            self._plain = self._footprint_binding.tiles
        return self._footprint_binding.sample(poses)

    def _tiles_that_see(self, area: Area) -> list[tuple[int, int]]:
        """Return the tiles with a footprint that reaches into an area of the raster."""
        reach = math.ceil(_TAPS // 2 * _TAP_STEP_M / self.pixel_m) + 1
        size = _TILE_CELLS // _CELLS_PER_PIXEL
        origin_x, origin_y = self._picture.origin
        left, bottom = (area[0] - reach + origin_x) // size, (area[1] - reach + origin_y) // size
        right, top = (area[2] + reach + origin_x) // size, (area[3] + reach + origin_y) // size
        return [(x, y) for y in range(bottom, top + 1) for x in range(left, right + 1)]

    def _plain_colors(self, tiles_x: _Indices, tiles_y: _Indices) -> _Indices:
        """Return the only color that each of these tiles sees, or _MIXED."""
        last_row, last_column = (size - 1 for size in self._plain.shape)
        rows = _within(tiles_y - self._corner[1], 0, last_row)  # tiles outside: see `_plain`
        columns = _within(tiles_x - self._corner[0], 0, last_column)
        colors = self._plain[rows, columns]
        unknown = (colors == _UNKNOWN).nonzero()[0]
        if len(unknown) > _MANY:
            self._survey()
            return self._plain_colors(tiles_x, tiles_y)
        if len(unknown):
            for row, column in {(int(rows[index]), int(columns[index])) for index in unknown}:
                seen = self._seen_by(column + self._corner[0], row + self._corner[1])[0]
                self._plain[row, column] = seen[0, 0] if (seen == seen[0, 0]).all() else _MIXED
            colors = self._plain[rows, columns]
        return colors.astype(np.intp)

    def _survey(self) -> None:
        """Find the only color of every tile: a tile sees one color if minimum and maximum of its pixels are equal."""
        height, width = self._picture.pixels.shape
        rows, columns = self._plain.shape
        bottoms, tops = self._spans(self._corner[1], rows, self._picture.origin[1], height)
        edges = np.stack(self._spans(self._corner[0], columns, self._picture.origin[0], width), axis=1).ravel() + 1
        # For each row of tiles, first reduce the pixels along y, then along x. `reduceat` reduces from each edge to the
        # next one; edges alternate begin, end of a tile, so every other result (::2) is that of a tile. Tiles overlap,
        # which `reduceat` allows.
        for row, (bottom, top) in enumerate(zip(bottoms.tolist(), tops.tolist(), strict=True)):
            band = self._picture.padded(bottom, top, -1, width + 2)
            low = np.minimum.reduceat(band.min(axis=0), edges)[::2]
            high = np.maximum.reduceat(band.max(axis=0), edges)[::2]
            self._plain[row] = np.where(low == high, low.astype(np.int32), _MIXED)

    def _spans(self, first: int, count: int, origin: int, size: int) -> tuple[_Indices, _Indices]:
        """Return the first pixel that each of `count` tiles sees along one axis, and the one after the last."""
        cells = (first + np.arange(count)) * _TILE_CELLS
        lowest, highest = (
            self._taps(cells, origin, size)[:, 0],
            self._taps(cells + _TILE_CELLS - 1, origin, size)[:, -1],
        )
        return lowest, highest + 1

    def _footprints(self, rows: _Indices, columns: _Indices) -> tuple[_Values, _Values]:
        """Return reflectances and parts of floor of footprints by the pixels of their taps, shape (footprints, taps).

        The sums have the order of `_weigh`, so that the bits are the same.
        """
        height, width = self._picture.pixels.shape
        columns = columns.T  # the taps along x come first, so that their sum is quick
        # seen: color numbers by tap along x, footprint, tap along y. Taps outside the raster were clamped to one pixel
        # beyond it; they see no floor, color 0.
        seen = self._picture.pixels[rows.clip(0, height - 1)[None, :, :], columns.clip(0, width - 1)[:, :, None]]
        if rows.min() < 0 or rows.max() == height or columns.min() < 0 or columns.max() == width:
            beyond = ((rows < 0) | (rows == height))[None, :, :] | ((columns < 0) | (columns == width))[:, :, None]
            seen[beyond] = 0
        gray = self._mean(self._picture.grays[seen])
        if seen.all():
            return gray, np.ones_like(gray)
        return _over_floor(gray, self._mean((seen == 0).astype(float)))

    def _mean(self, values: _Values) -> _Values:
        """Return the weighted mean over the taps, given values by tap along x, footprint, tap along y."""
        across = self._weights[0] * values[0]
        for tap in range(1, _TAPS):
            across += self._weights[tap] * values[tap]
        mean: _Values = self._weights[0] * across[:, 0]
        for tap in range(1, _TAPS):
            mean += self._weights[tap] * across[:, tap]
        return mean

    def _blur(self, tile_x: int, tile_y: int) -> tuple[_Values, _Values] | GroundSample:
        """Return the samples of all cells of a tile, or a single one if the tile sees one color only."""
        seen, rows, columns = self._seen_by(tile_x, tile_y)
        if (seen == seen[0, 0]).all():
            return GroundSample(float(self._picture.grays[seen[0, 0]]), 1.0) if seen[0, 0] else NO_FLOOR
        gray = self._weigh(self._picture.grays[seen], rows, columns)
        if seen.all():
            return gray, np.ones_like(gray)
        return _over_floor(gray, self._weigh((seen == 0).astype(float), rows, columns))

    def _seen_by(self, tile_x: int, tile_y: int) -> tuple[npt.NDArray[np.uint16], _Indices, _Indices]:
        """Return the part of the raster that a tile sees, and rows and columns of the taps in it, (cells, taps)."""
        height, width = self._picture.pixels.shape
        cells = np.arange(_TILE_CELLS)
        columns = self._taps(tile_x * _TILE_CELLS + cells, self._picture.origin[0], width)
        rows = self._taps(tile_y * _TILE_CELLS + cells, self._picture.origin[1], height)
        first_row, first_column = int(rows.min()), int(columns.min())
        seen = self._picture.padded(first_row, int(rows.max()) + 1, first_column, int(columns.max()) + 1)
        return seen, rows - first_row, columns - first_column

    def _taps(self, cells: _Indices, origin: int, size: int) -> _Indices:
        """Return the pixel of each tap of cells along one axis, clamped to one pixel around the raster."""
        places = (cells[:, None] + 0.5) * self._cell_m + (np.arange(_TAPS) - _TAPS // 2)[None, :] * _TAP_STEP_M
        pixels = np.floor(places / self.pixel_m).astype(np.intp) - origin
        return _within(pixels, -1, size)

    def _weigh(self, values: _Values, rows: _Indices, columns: _Indices) -> _Values:
        """Return the weighted mean over the taps for all cells of a tile.

        The Gaussian is separable: sums along the columns, then of these along the rows, 9 + 9 taps instead of 81.
        """
        across = self._weights[0] * values.take(columns[:, 0], axis=1)
        for tap in range(1, _TAPS):
            across += self._weights[tap] * values.take(columns[:, tap], axis=1)
        blurred: _Values = self._weights[0] * across.take(rows[:, 0], axis=0)
        for tap in range(1, _TAPS):
            blurred += self._weights[tap] * across.take(rows[:, tap], axis=0)
        return blurred


def _within(numbers: _Indices, low: int, high: int) -> _Indices:
    """Do what `numpy.clip` does, in a third of the time for few numbers."""
    found: _Indices = np.minimum(np.maximum(numbers, low), high)
    return found


def _over_floor(gray: _Values, missing: _Values) -> tuple[_Values, _Values]:
    """Return the mean gray of the floor in each footprint, and which part of it is floor.

    `missing` is the part without floor, which counts as black in `gray`.
    """
    floor = np.where(missing < 1.0 - 1e-9, 1.0 - missing, 0.0)
    return np.divide(gray, floor, out=np.zeros_like(gray), where=floor > 0.0), floor
