"""The raster of the ground: the color of each square of `pixel_m`, and where there is no floor.

A pixel is 1 mm wide (more if the ground is very large) and aligned with the world's origin. Floors are filled first,
paint and prints cover floor only, and a pen draws on it; drawings can be erased.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.ground.decals import Area, area_of, bands, few_colors, laid_on
from thymio_sim_ros.sim.model.geometry import Point
from thymio_sim_ros.sim.model.primitives import Color, Floor, Mark, Print

__all__ = ["MAX_COST", "Area", "Picture", "cost", "grid_of"]

_PIXEL_M = 0.001
_MAX_PIXELS = 25_000_000
_MAX_COLORS = 65_534

_SPARE_COLORS = 1000
"""Color numbers that prints leave free for paint and pens that come later."""

MAX_COST = 1_200_000_000
"""Largest `cost` that is accepted: two prints on the largest ground, or thirty floors of its size."""
_ROW_COST, _PRINT_COST = 2000, 20
"""Measured cost of a row and of a pixel of a print, in pixels of paint."""


def cost(floors: Sequence[Floor], paints: Sequence[Mark]) -> int:
    """The cost of rasterizing a ground, in pixels of paint; each takes about a nanosecond."""
    pixel_m, origin, shape = grid_of(floors)
    found = 0
    for mark in (*floors, *paints):
        left, bottom, right, top = area_of(mark, pixel_m, origin, shape)
        rows = top - bottom
        found += rows * (_ROW_COST + (right - left) * (_PRINT_COST if isinstance(mark, Print) else 1))
    return found


def grid_of(floors: Sequence[Floor]) -> tuple[float, tuple[int, int], tuple[int, int]]:
    """The size of a pixel in m, column and row of the first pixel, and number of rows and columns."""
    corners = [vertex for floor in floors for vertex in floor.vertices] or [(0.0, 0.0)]
    low_x, low_y = (min(corner[axis] for corner in corners) for axis in (0, 1))
    high_x, high_y = (max(corner[axis] for corner in corners) for axis in (0, 1))
    pixel_m = max(_PIXEL_M, math.sqrt((high_x - low_x) * (high_y - low_y) / _MAX_PIXELS))
    origin = (math.floor(low_x / pixel_m), math.floor(low_y / pixel_m))
    width = math.ceil(high_x / pixel_m) - origin[0] + 1
    height = math.ceil(high_y / pixel_m) - origin[1] + 1
    return pixel_m, origin, (height, width)


class Picture:
    """Colors by number; number 0 is where there is no floor. Invariant: drawing never makes nor removes floor."""

    COLORS = _MAX_COLORS + 1
    """Color numbers that there can be."""

    def __init__(
        self,
        floors: Sequence[Floor],
        paints: Sequence[Mark],
        pixels: npt.NDArray[np.uint16],
        grays: npt.NDArray[np.float64],
    ) -> None:
        """Rasterize floors and paint.

        Args:
            floors: where there is floor, later ones on earlier ones.
            paints: markings on the floor, later ones on earlier ones.
            pixels: zeros, in the shape of `grid_of`; gets the color numbers by row (y) and column (x).
            grays: zeros, shape (COLORS,); gets the gray 0…1 of each color: the mean of its parts.
        """
        self.pixel_m, self.origin, _ = grid_of(floors)
        """Size of a pixel, and column and row of the first one, counted from the world's origin."""
        self.pixels, self.grays = pixels, grays
        self._palette: list[Color] = [(0.0, 0.0, 0.0)]
        self._numbers: dict[Color, int] = {}
        for floor in floors:
            self._fill(floor.vertices, floor.color, everywhere=True)
        self._first = self._first_now = self._number(floors[0].color) if floors else 0
        """The color number of the first floor, at the start and now."""
        for paint in paints:
            if isinstance(paint, Print):
                self._print(paint)
            else:
                self._fill(paint.vertices, paint.color, everywhere=False)
        self._before: npt.NDArray[np.uint16] | None = None
        """The pixels before anything was drawn; None while nothing is."""

    def color_at(self, x_m: float, y_m: float) -> Color | None:
        """The color at a point, or None where there is no floor."""
        column = math.floor(x_m / self.pixel_m) - self.origin[0]
        row = math.floor(y_m / self.pixel_m) - self.origin[1]
        height, width = self.pixels.shape
        if not (0 <= column < width and 0 <= row < height):
            return None
        number = int(self.pixels[row, column])
        return self._palette[number] if number else None

    def draw_segment(
        self, x0_m: float, y0_m: float, x1_m: float, y1_m: float, width_m: float, color: Color | None
    ) -> Area | None:
        """Draw a line with round ends on the floor, at least a pixel wide; None as color erases drawings.

        Returns the pixels that may have changed, or None if there are none.
        """
        scale = 1.0 / self.pixel_m
        ax, ay = x0_m * scale - self.origin[0], y0_m * scale - self.origin[1]
        dx, dy = (x1_m - x0_m) * scale, (y1_m - y0_m) * scale
        radius = max(width_m * scale, 1.0) / 2
        height, width = self.pixels.shape
        left, right = max(0, math.floor(min(ax, ax + dx) - radius)), min(width, math.ceil(max(ax, ax + dx) + radius))
        bottom, top = max(0, math.floor(min(ay, ay + dy) - radius)), min(height, math.ceil(max(ay, ay + dy) + radius))
        if left >= right or bottom >= top or (color is None and self._before is None):
            return None
        px, py = np.arange(left, right)[None, :] + (0.5 - ax), np.arange(bottom, top)[:, None] + (0.5 - ay)
        # A pixel is covered if its center is within the radius of the segment: `along` is the parameter 0…1 of the
        # nearest point of the segment, the clamped projection.
        square = dx * dx + dy * dy
        along = np.clip((px * dx + py * dy) / square, 0.0, 1.0) if square > 0.0 else np.zeros((1, 1))
        covered = (px - along * dx) ** 2 + (py - along * dy) ** 2 <= radius * radius
        if self._before is None:
            self._before = self.pixels.copy()
        pixels, before = self.pixels[bottom:top, left:right], self._before[bottom:top, left:right]
        if color is None:
            pixels[covered] = before[covered]
        else:
            pixels[covered & (before > 0)] = self._number(color)
        return (left, bottom, right, top)

    def restore(self) -> bool:
        """Erase everything that was drawn; returns whether there was anything."""
        if self._before is None:
            return False
        self.pixels[:], self._before = self._before, None
        return True

    def paint(self, color: Color | None) -> bool:
        """Give the first floor another color, or its own with None; returns whether that is a change.

        What has the same color as the floor, such as paint that cannot be seen on it, follows it.
        """
        number = self._first if color is None else self._number(color)
        if number == self._first_now or not self._first:
            return False
        for pixels in (self.pixels, self._before):
            if pixels is not None:
                pixels[pixels == self._first_now] = number
        self._first_now = number
        return True

    def _fill(self, vertices: Sequence[Point], color: Color, *, everywhere: bool) -> None:
        """Paint the pixels whose center lies in a convex polygon; without `everywhere` only those that are floor.

        Scan line by scan line: a counter-clockwise polygon is right of its descending sides and left of its ascending
        ones, so the span of a row is from the largest crossing of the former to the smallest of the latter.
        """
        number = self._number(color)
        xs = [x / self.pixel_m - self.origin[0] for x, _ in vertices]
        ys = [y / self.pixel_m - self.origin[1] for _, y in vertices]
        height, width = self.pixels.shape
        bottom, top = max(0, math.floor(min(ys))), min(height, math.ceil(max(ys)) + 1)
        row = np.arange(bottom, top) + 0.5
        left, right = np.full(len(row), min(xs)), np.full(len(row), max(xs))
        outside = np.zeros(len(row), dtype=bool)
        for this in range(len(xs)):
            ax, ay, bx, by = xs[this - 1], ys[this - 1], xs[this], ys[this]
            if by == ay:  # a horizontal side has no crossing; rows below or above it are outside
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
            pixels = self.pixels[bottom + line, first[line] : last[line]]
            if everywhere:
                pixels[:] = number
            else:
                pixels[pixels > 0] = number

    def _print(self, printed: Print) -> None:
        """Put a print on the floor; transparent parts mix with the ground.

        There are at most 65 535 color numbers. The first pass collects the colors of all pixels; they are then reduced
        to those that are free, and the second pass writes them.
        """
        palette = np.array(self._palette) * 255
        covered, codes = [], []
        for (left, bottom, right, top), words in bands(printed, self.pixel_m, self.origin, self.pixels.shape):
            under = self.pixels[bottom:top, left:right]
            here = (words >= 1 << 24) & (under > 0)
            covered.append((left, bottom, right, top, np.packbits(here)))
            codes.append(laid_on(words[here], under[here], palette))
        if not sum(map(len, codes)):
            return
        colors, table = few_colors(codes, max(1, _MAX_COLORS + 1 - len(self._palette) - _SPARE_COLORS))
        found = [self._number((red / 255, green / 255, blue / 255)) for red, green, blue in colors.tolist()]
        numbers = np.array(found, dtype=np.uint16)
        for (left, bottom, right, top, packed), code in zip(covered, codes, strict=True):
            under = self.pixels[bottom:top, left:right]
            here = np.unpackbits(packed, count=under.size).reshape(under.shape).astype(bool)
            under[here] = numbers[table[code]]

    def _number(self, color: Color) -> int:
        """The number of a color; if there are too many colors, that of the color with the nearest gray."""
        known = self._numbers.get(color)
        if known is not None:
            return known
        gray = sum(color) / 3
        if len(self._palette) <= _MAX_COLORS:
            number = self._numbers[color] = len(self._palette)
            self._palette.append(color)
            self.grays[number] = gray
            return number
        return int(np.argmin(np.abs(self.grays[1:] - gray))) + 1
