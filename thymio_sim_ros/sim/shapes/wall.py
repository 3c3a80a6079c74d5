"""A straight wall from one point to another."""

from __future__ import annotations

import math
from dataclasses import dataclass

from thymio_sim_ros.sim.model.fields import Coordinate, Extent, Shade, as_color
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Box, Primitive, Solid
from thymio_sim_ros.sim.shapes import ShapeKind


@dataclass(frozen=True, slots=True)
class Wall:
    """A wall whose middle line goes from start to end; both ends reach half a thickness farther, so corners close."""

    start_x_m: Coordinate
    start_y_m: Coordinate
    end_x_m: Coordinate
    end_y_m: Coordinate
    color: Shade
    thickness_m: Extent = 0.02
    height_m: Extent = 0.12

    def primitives(self, name: str) -> tuple[Primitive, ...]:
        """One solid."""
        dx, dy = self.end_x_m - self.start_x_m, self.end_y_m - self.start_y_m
        pose = Pose(self.start_x_m + dx / 2, self.start_y_m + dy / 2, math.atan2(dy, dx))
        outline = Box(math.hypot(dx, dy) + self.thickness_m, self.thickness_m)
        return (Solid(name, pose, outline, self.height_m, as_color(self.color)),)


SHAPE = ShapeKind("wall", Wall, sample={"color": "#8a97a5"})
