"""Zones of a mission: rectangles, turned or not, and discs, in which a robot is or is not."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

from thymio_sim_ros.sim.model.fields import Angle, Coordinate, Extent
from thymio_sim_ros.sim.model.spatial_grid import Bounds

__all__ = ["ZONES", "Zone"]


class Zone(Protocol):
    """An area of the floor: a frozen dataclass."""

    def contains(self, x_m: float, y_m: float) -> bool:
        """Whether a point is inside."""

    @property
    def bounds(self) -> Bounds:
        """Left, bottom, right, top, in m; it may lie inside of them."""


@dataclass(frozen=True, slots=True)
class Rectangle:
    """A rectangle by its center and its sides; `yaw_rad` turns it counter-clockwise."""

    x_m: Coordinate
    y_m: Coordinate
    size_x_m: Extent
    size_y_m: Extent
    yaw_rad: Angle = 0.0

    def contains(self, x_m: float, y_m: float) -> bool:
        """Whether a point is inside."""
        x, y = x_m - self.x_m, y_m - self.y_m
        cosine, sine = math.cos(self.yaw_rad), math.sin(self.yaw_rad)
        along, across = x * cosine + y * sine, y * cosine - x * sine
        return abs(along) <= self.size_x_m / 2 and abs(across) <= self.size_y_m / 2

    @property
    def bounds(self) -> Bounds:
        """Left, bottom, right, top, in m."""
        cosine, sine = abs(math.cos(self.yaw_rad)), abs(math.sin(self.yaw_rad))
        half_x = (self.size_x_m * cosine + self.size_y_m * sine) / 2
        half_y = (self.size_x_m * sine + self.size_y_m * cosine) / 2
        return self.x_m - half_x, self.y_m - half_y, self.x_m + half_x, self.y_m + half_y


@dataclass(frozen=True, slots=True)
class Disc:
    """A disc by its center and its radius."""

    x_m: Coordinate
    y_m: Coordinate
    radius_m: Extent

    def contains(self, x_m: float, y_m: float) -> bool:
        """Whether a point is inside."""
        return math.hypot(x_m - self.x_m, y_m - self.y_m) <= self.radius_m

    @property
    def bounds(self) -> Bounds:
        """Left, bottom, right, top, in m."""
        return self.x_m - self.radius_m, self.y_m - self.radius_m, self.x_m + self.radius_m, self.y_m + self.radius_m


ZONES: Mapping[str, type[Zone]] = {"rectangle": Rectangle, "disc": Disc}
"""The kinds of zones by the word of a mission file."""
