"""A rectangular piece of ground, with or without walls (docs/spec/playground-formats.md section 2: planes)."""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.sim.model.fields import Angle, Coordinate, Extent, Shade, as_color
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Box, Floor, Primitive, Solid
from thymio_sim_ros.sim.shapes import ShapeKind
from thymio_sim_ros.sim.shapes._border import Walls, wall_name


@dataclass(frozen=True, slots=True)
class Rectangle:
    """Ground of a size, centered on its pose."""

    size_x_m: Extent
    size_y_m: Extent
    color: Shade
    x_m: Coordinate = 0.0
    y_m: Coordinate = 0.0
    yaw_rad: Angle = 0.0
    walls: Walls | None = None

    def primitives(self, name: str) -> tuple[Primitive, ...]:
        """One floor, and four walls that overlap at the corners."""
        pose = Pose(self.x_m, self.y_m, self.yaw_rad)
        corners = pose.place_all(Box(self.size_x_m, self.size_y_m).vertices)
        floor = Floor(name, corners, as_color(self.color))
        if self.walls is None:
            return (floor,)
        return (floor, *self._borders(name, pose, self.walls))

    def _borders(self, name: str, pose: Pose, walls: Walls) -> tuple[Solid, ...]:
        thick = walls.thickness_m
        along_x, along_y = Box(self.size_x_m + thick, thick), Box(thick, self.size_y_m + thick)
        x, y = self.size_x_m / 2, self.size_y_m / 2
        color = as_color(walls.color or self.color)
        return tuple(
            Solid(
                wall_name(name, self.yaw_rad, 2 * quarter),
                Pose(*pose.place(middle), self.yaw_rad),
                box,
                walls.height_m,
                color,
            )
            for quarter, (middle, box) in enumerate(
                (((x, 0.0), along_y), ((0.0, y), along_x), ((-x, 0.0), along_y), ((0.0, -y), along_x))
            )
        )


SHAPE = ShapeKind("rectangle", Rectangle, sample={"size_x_m": 0.4, "size_y_m": 0.3, "color": "#ffffff"})
