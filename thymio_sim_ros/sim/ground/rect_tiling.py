"""An image as a few rectangles of one color, for viewers without textures; coarser if it has much detail."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from thymio_sim_ros.sim.formats.image_io import Pixels

__all__ = ["Tile", "mosaic"]

_FINEST = 256
_MOST_TILES = 4000
_SHADES = 16
"""Shades of each color: nearly equal pixels join into one tile."""


@dataclass(frozen=True, slots=True)
class Tile:
    """A rectangle of one color (red, green, blue, opacity 0…1); edges are parts of the image, from the lower left."""

    left: float
    bottom: float
    right: float
    top: float
    color: tuple[float, float, float, float]


def mosaic(pixels: Pixels, *, most: int = _MOST_TILES) -> list[Tile]:
    """At most `most` tiles (clamped to 1…4000): runs of equal color in as many rows as that allows."""
    most = max(1, min(most, _MOST_TILES))
    image = np.frombuffer(pixels.rgba, dtype=np.uint8).reshape(pixels.rows, pixels.columns, 4)
    finest = _FINEST
    while True:
        scale = min(1.0, finest / max(pixels.columns, pixels.rows))
        columns, rows = max(1, round(pixels.columns * scale)), max(1, round(pixels.rows * scale))
        tiles = _tiles(image, columns, rows)
        if len(tiles) <= most:
            return tiles
        finest //= 2


def _tiles(image: np.ndarray[tuple[int, ...], np.dtype[np.uint8]], columns: int, rows: int) -> list[Tile]:
    height, width = image.shape[:2]
    across = ((np.arange(columns) + 0.5) * width / columns).astype(int)
    down = ((np.arange(rows) + 0.5) * height / rows).astype(int)
    shades = np.rint(image[down][:, across] / 255 * (_SHADES - 1)).astype(int)
    tiles = []
    for row in range(rows):
        line = shades[row]
        breaks = [0, *(np.flatnonzero((line[1:] != line[:-1]).any(axis=1)) + 1).tolist(), columns]
        for begin, end in itertools.pairwise(breaks):
            red, green, blue, opacity = (line[begin] / (_SHADES - 1)).tolist()
            if opacity > 0:
                top, bottom = 1 - row / rows, 1 - (row + 1) / rows
                tiles.append(Tile(begin / columns, bottom, end / columns, top, (red, green, blue, opacity)))
    return tiles
