"""A regular octagon of ground, with or without walls (docs/spec/playground-formats.md section 2: octagons)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from thymio_sim_ros.sim.model.fields import Angle, Coordinate, Extent, Shade, as_color
from thymio_sim_ros.sim.model.geometry import Point, Pose
from thymio_sim_ros.sim.model.primitives import Box, Floor, Primitive, Solid
from thymio_sim_ros.sim.shapes import ShapeKind
from thymio_sim_ros.sim.shapes._border import Walls, wall_name

_EIGHTH = math.pi / 4


@dataclass(frozen=True, slots=True)
class Octagon:
    """Ground with eight sides of one length, two of them along its x axis, centered on its pose."""

    side_m: Extent
    color: Shade
    x_m: Coordinate = 0.0
    y_m: Coordinate = 0.0
    yaw_rad: Angle = 0.0
    walls: Walls | None = None

    def primitives(self, name: str) -> tuple[Primitive, ...]:
        """One floor, and eight walls, each half a thickness longer than its side."""
        pose = Pose(self.x_m, self.y_m, self.yaw_rad)
        circumradius = self.side_m / 2 / math.sin(_EIGHTH / 2)
        corners = tuple(_polar(circumradius, (index + 0.5) * _EIGHTH) for index in range(8))
        floor = Floor(name, pose.place_all(corners), as_color(self.color))
        if self.walls is None:
            return (floor,)
        return (floor, *self._borders(name, pose, self.walls))

    def _borders(self, name: str, pose: Pose, walls: Walls) -> tuple[Solid, ...]:
        apothem = self.side_m / 2 / math.tan(_EIGHTH / 2)
        wall = Box(walls.thickness_m, self.side_m + walls.thickness_m / 2)
        color = as_color(walls.color or self.color)
        return tuple(
            Solid(
                wall_name(name, self.yaw_rad, index),
                Pose(*pose.place(_polar(apothem, index * _EIGHTH)), self.yaw_rad + index * _EIGHTH),
                wall,
                walls.height_m,
                color,
            )
            for index in range(8)
        )


def _polar(radius: float, angle: float) -> Point:
    return (radius * math.cos(angle), radius * math.sin(angle))


SHAPE = ShapeKind("octagon", Octagon, sample={"side_m": 0.2, "color": "#ffffff"})
