"""A box that cannot be moved."""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.sim import primitives
from thymio_sim_ros.sim.fields import Angle, Coordinate, Extent, Shade, as_color
from thymio_sim_ros.sim.geometry import Pose
from thymio_sim_ros.sim.primitives import Primitive, Solid
from thymio_sim_ros.sim.shapes import ShapeKind


@dataclass(frozen=True, slots=True)
class Box:
    """A box of a size, centred on its pose."""

    x_m: Coordinate
    y_m: Coordinate
    size_x_m: Extent
    size_y_m: Extent
    height_m: Extent
    color: Shade
    yaw_rad: Angle = 0.0

    def primitives(self, name: str) -> tuple[Primitive, ...]:
        """One solid."""
        outline = primitives.Box(self.size_x_m, self.size_y_m)
        pose = Pose(self.x_m, self.y_m, self.yaw_rad)
        return (Solid(name, pose, outline, self.height_m, as_color(self.color)),)


SHAPE = ShapeKind("box", Box)
