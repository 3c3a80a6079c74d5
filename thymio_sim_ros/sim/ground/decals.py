"""Prints (images on the floor) in the raster of the ground: resampling, mixing with the ground, reducing the colors.

The work is done in bands of rows: a print of 25 million pixels would otherwise need a gigabyte of intermediate values.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.model.primitives import Floor, Mark, Print

__all__ = ["Area", "area_of", "bands", "few_colors", "laid_on"]

_Bytes = npt.NDArray[np.uint8]
_Words = npt.NDArray[np.uint32]
_Codes = npt.NDArray[np.uint32]

_CODES = 1 << 24
"""Colors of three bytes; tables over all of them are far faster than sorting the pixels of a large print."""
_BAND_PIXELS = 1_000_000

Area = tuple[int, int, int, int]
"""Pixels of the ground: left, bottom, right, top; the last two not included."""


def area_of(mark: Floor | Mark, pixel_m: float, origin: tuple[int, int], shape: tuple[int, int]) -> Area:
    """The pixels of the bounding box of a mark, clipped to a ground of `shape` rows and columns.

    `origin` are column and row of its first pixel. The area is empty if they do not overlap.
    """
    xs = [x / pixel_m - origin[0] for x, _ in mark.vertices]
    ys = [y / pixel_m - origin[1] for _, y in mark.vertices]
    left, right = max(0, math.floor(min(xs))), min(shape[1], math.ceil(max(xs)))
    bottom, top = max(0, math.floor(min(ys))), min(shape[0], math.ceil(max(ys)))
    return (left, bottom, right, top) if left < right and bottom < top else (0, 0, 0, 0)


def bands(
    printed: Print, pixel_m: float, origin: tuple[int, int], shape: tuple[int, int]
) -> Iterator[tuple[Area, _Words]]:
    """A print band by band from below: area of the band, and its colors, shape (rows, columns).

    A color is the number 0xaabbggrr: opacity, blue, green, red; it is 0 outside of the print. A print finer than the
    ground is averaged over whole blocks first.
    """
    left, bottom, right, top = area_of(printed, pixel_m, origin, shape)
    if left >= right:
        return
    source = np.frombuffer(printed.rgba, dtype=np.uint8).reshape(printed.rows, printed.columns, 4)
    size_x, size_y = printed.size_x_m / printed.columns, printed.size_y_m / printed.rows
    merge_x, merge_y = max(1, math.floor(pixel_m / size_x + 1e-9)), max(1, math.floor(pixel_m / size_y + 1e-9))
    words: _Words = _blocks(source, merge_x, merge_y).view("<u4")[..., 0]
    # Centers of the ground's pixels relative to the print, turned into its frame: column and row of the print's pixel
    # there (nearest neighbor; its rows count from the top).
    x = (np.arange(left, right) + 0.5 + origin[0]) * pixel_m - printed.pose.x_m
    cos, sin = math.cos(printed.pose.yaw_rad), math.sin(printed.pose.yaw_rad)
    height = max(1, _BAND_PIXELS // (right - left))
    for begin in range(bottom, top, height):
        end = min(top, begin + height)
        y = (np.arange(begin, end) + 0.5 + origin[1]) * pixel_m - printed.pose.y_m
        colors = np.zeros((end - begin, right - left), dtype=np.uint32)
        if sin == 0.0:  # nearly all prints: columns depend on x alone and rows on y alone
            column = np.floor((cos * x + printed.size_x_m / 2) / (size_x * merge_x)).astype(np.intp)
            row = np.floor((printed.size_y_m / 2 - cos * y) / (size_y * merge_y)).astype(np.intp)
            across = np.flatnonzero((column >= 0) & (column < words.shape[1]))
            for line in np.flatnonzero((row >= 0) & (row < words.shape[0])).tolist() if len(across) else ():
                colors[line, across[0] : across[-1] + 1] = words[row[line]].take(column[across])
        else:
            for line in range(end - begin):
                column = np.floor((cos * x + sin * y[line] + printed.size_x_m / 2) / (size_x * merge_x)).astype(np.intp)
                row = np.floor((printed.size_y_m / 2 + sin * x - cos * y[line]) / (size_y * merge_y)).astype(np.intp)
                inside = (column >= 0) & (column < words.shape[1]) & (row >= 0) & (row < words.shape[0])
                colors[line, inside] = words[row[inside], column[inside]]
        yield (left, begin, right, end), colors


def laid_on(words: _Words, under: npt.NDArray[np.uint16], palette: npt.NDArray[np.float64]) -> _Codes:
    """The colors 0xrrggbb that pixels of a print have on the ground, shape (pixels,).

    Args:
        words: colors 0xaabbggrr of the print, none fully transparent, shape (pixels,).
        under: color numbers of the ground, shape (pixels,).
        palette: red, green, blue of each color number, 0…255, shape (numbers, 3).
    """
    codes = ((words & 0xFF) << 16 | words & 0xFF00 | words >> 16 & 0xFF).astype(np.uint32, copy=False)
    mixed = np.flatnonzero(words < 0xFF000000)  # not opaque: alpha blending
    if len(mixed):
        parts = (words[mixed] >> 24) / 255
        ground = palette[under[mixed]]
        code = np.zeros(len(mixed), dtype=np.uint32)
        for channel in range(3):
            color = codes[mixed] >> (16 - 8 * channel) & 0xFF
            code <<= 8
            code |= np.rint(color * parts + ground[:, channel] * (1 - parts)).astype(np.uint32)
        codes[mixed] = code
    return codes


def few_colors(codes: Sequence[_Codes], most: int) -> tuple[_Bytes, npt.NDArray[np.uint16]]:
    """Reduce colors to at most `most`, which must not be above 65 536.

    If more colors occur, the color cube is divided into cells, each color is replaced by the mean of the pixels in its
    cell, and the cells are as small as possible.

    Returns:
        The colors, shape (colors, 3), and the index of the color for each code 0xrrggbb, shape (2**24,).
    """
    occurs = np.zeros(_CODES, dtype=bool)
    for part in codes:
        occurs[part] = True
    if np.count_nonzero(occurs) <= most:
        distinct = np.flatnonzero(occurs)
        table = np.zeros(_CODES, dtype=np.uint16)
        table[distinct] = np.arange(len(distinct))
        return np.stack([distinct >> 16, distinct >> 8 & 0xFF, distinct & 0xFF]).T.astype(np.uint8), table
    cube: npt.NDArray[np.bool_] = occurs.reshape(256, 256, 256)
    bits = 0
    while bits == 0 or (np.count_nonzero(cube) > most and bits < 8):
        # Merge eight neighbors of the cube into one cell: `side` cells of 2**bits shades along each axis.
        bits += 1
        side = 256 >> bits
        cube = np.asarray(cube.reshape(side, 2, side, 2, side, 2).any(axis=(1, 3, 5)))
    side = len(cube)
    total, sums = np.zeros(cube.size), np.zeros((3, cube.size))
    for part in codes:
        channels = (part >> 16, part >> 8 & 0xFF, part & 0xFF)
        red, green, blue = (channel >> bits for channel in channels)
        group = (red * side + green) * side + blue
        total += np.bincount(group, minlength=cube.size)
        for number, channel in enumerate(channels):
            sums[number] += np.bincount(group, weights=channel, minlength=cube.size)
    groups = np.flatnonzero(cube)
    place = np.zeros(cube.size, dtype=np.uint16)
    place[groups] = np.arange(len(groups))
    places: npt.NDArray[np.uint16] = place.reshape(cube.shape)
    for axis in range(3):
        places = places.repeat(1 << bits, axis=axis)
    return np.rint(sums[:, groups] / total[groups]).T.astype(np.uint8), places.ravel()


def _blocks(source: _Bytes, across: int, down: int) -> _Bytes:
    """The means over blocks of pixels, weighted by opacity; the last blocks may be smaller."""
    if across == down == 1:
        return source
    rows, columns = math.ceil(source.shape[0] / down), math.ceil(source.shape[1] / across)
    merged = np.zeros((rows, columns, 4), dtype=np.uint8)
    height = max(1, _BAND_PIXELS // (down * source.shape[1]))
    for begin in range(0, rows, height):
        merged[begin : begin + height] = _means(source[begin * down : (begin + height) * down], across, down)
    return merged


def _means(source: _Bytes, across: int, down: int) -> _Bytes:
    rows, columns = math.ceil(source.shape[0] / down), math.ceil(source.shape[1] / across)
    padded = np.zeros((rows * down, columns * across, 4), dtype=np.float32)
    padded[: source.shape[0], : source.shape[1]] = source
    # Colors are averaged with the opacity as weight (premultiplied alpha), so that transparent pixels have no color.
    padded[..., :3] *= padded[..., 3:] / 255
    there = np.zeros((rows * down, columns * across), dtype=np.float32)
    there[: source.shape[0], : source.shape[1]] = 1.0
    sums = padded.reshape(rows, down, columns, across, 4).sum(axis=(1, 3))
    number = there.reshape(rows, down, columns, across).sum(axis=(1, 3))
    opacity = sums[..., 3] / number
    part = np.where(opacity > 0, opacity / 255, 1.0) * number
    merged: _Bytes = np.rint(np.dstack([*(sums[..., channel] / part for channel in range(3)), opacity])).astype(
        np.uint8
    )
    return merged
