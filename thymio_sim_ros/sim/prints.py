"""A print in the raster of the ground: which color each of the ground's pixels takes, and with few enough colors."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.primitives import Print

__all__ = ["few_colors", "rastered"]

_Bytes = npt.NDArray[np.uint8]

_CODES = 1 << 24
"""Colors of three bytes; tables over all of them are far faster than sorting the pixels of a large print."""


def rastered(
    printed: Print, pixel_m: float, origin: tuple[int, int], shape: tuple[int, int]
) -> tuple[tuple[int, int, int, int], _Bytes]:
    """Pixels of the ground under a print (left, bottom, right, top; the last two not included), and its colors there.

    The ground has `shape` rows and columns of `pixel_m`, its first pixel at `origin`. Colors are red, green, blue,
    opacity, 0…255, by row (y) and column (x). A print finer than the ground is averaged over whole blocks first.
    """
    source = np.frombuffer(printed.rgba, dtype=np.uint8).reshape(printed.rows, printed.columns, 4)
    size_x, size_y = printed.size_x_m / printed.columns, printed.size_y_m / printed.rows
    merge_x, merge_y = max(1, math.floor(pixel_m / size_x + 1e-9)), max(1, math.floor(pixel_m / size_y + 1e-9))
    source = _blocks(source, merge_x, merge_y)
    xs = [x / pixel_m - origin[0] for x, _ in printed.vertices]
    ys = [y / pixel_m - origin[1] for _, y in printed.vertices]
    left, right = max(0, math.floor(min(xs))), min(shape[1], math.ceil(max(xs)))
    bottom, top = max(0, math.floor(min(ys))), min(shape[0], math.ceil(max(ys)))
    if left >= right or bottom >= top:
        return (0, 0, 0, 0), np.zeros((0, 0, 4), dtype=np.uint8)
    x = (np.arange(left, right) + 0.5 + origin[0]) * pixel_m - printed.pose.x_m
    y = (np.arange(bottom, top) + 0.5 + origin[1]) * pixel_m - printed.pose.y_m
    cos, sin = math.cos(printed.pose.yaw_rad), math.sin(printed.pose.yaw_rad)
    colors = np.zeros((top - bottom, right - left, 4), dtype=np.uint8)
    for line in range(top - bottom):
        column = np.floor((cos * x + sin * y[line] + printed.size_x_m / 2) / (size_x * merge_x)).astype(np.intp)
        row = np.floor((printed.size_y_m / 2 + sin * x - cos * y[line]) / (size_y * merge_y)).astype(np.intp)
        inside = (column >= 0) & (column < source.shape[1]) & (row >= 0) & (row < source.shape[0])
        colors[line, inside] = source[row[inside], column[inside]]
    return (left, bottom, right, top), colors


def few_colors(colors: _Bytes, most: int) -> tuple[_Bytes, npt.NDArray[np.int32]]:
    """At most `most` colors that stand for n x 3 bytes, and which of them each one becomes.

    All that occur, if they are few enough; otherwise near ones are replaced by their mean.
    """
    codes = (colors[:, 0].astype(np.uint32) << 16) | (colors[:, 1].astype(np.uint32) << 8) | colors[:, 2]
    occurs = np.zeros(_CODES, dtype=bool)
    occurs[codes] = True
    distinct = np.flatnonzero(occurs)
    groups, member = distinct, np.arange(len(distinct))
    for bits in range(1, 9):
        if len(groups) <= most:
            break
        keep = 0xFF >> bits << bits
        groups, member = np.unique(distinct & (keep << 16 | keep << 8 | keep), return_inverse=True)
    parts = np.stack([distinct >> 16, distinct >> 8 & 0xFF, distinct & 0xFF])
    if len(groups) < len(distinct):
        number = np.bincount(codes, minlength=_CODES)[distinct]
        total = np.bincount(member, weights=number)
        parts = np.stack([np.rint(np.bincount(member, weights=part * number) / total) for part in parts])
    place = np.zeros(_CODES, dtype=np.int32)
    place[distinct] = member
    return parts.T.astype(np.uint8), place[codes]


def _blocks(source: _Bytes, across: int, down: int) -> _Bytes:
    """Means over blocks of pixels, weighted by opacity; the last ones may be smaller."""
    if across == down == 1:
        return source
    rows, columns = math.ceil(source.shape[0] / down), math.ceil(source.shape[1] / across)
    padded = np.zeros((rows * down, columns * across, 4), dtype=np.float32)
    padded[: source.shape[0], : source.shape[1]] = source
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
