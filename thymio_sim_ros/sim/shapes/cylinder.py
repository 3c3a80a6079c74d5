"""A cylinder that cannot be moved."""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.sim.fields import Coordinate, Extent, Shade, as_color
from thymio_sim_ros.sim.geometry import Pose
from thymio_sim_ros.sim.primitives import Disc, Primitive, Solid
from thymio_sim_ros.sim.shapes import ShapeKind


@dataclass(frozen=True, slots=True)
class Cylinder:
    """An upright cylinder."""

    x_m: Coordinate
    y_m: Coordinate
    radius_m: Extent
    height_m: Extent
    color: Shade

    def primitives(self, name: str) -> tuple[Primitive, ...]:
        """One solid."""
        pose = Pose(self.x_m, self.y_m, 0.0)
        return (Solid(name, pose, Disc(self.radius_m), self.height_m, as_color(self.color)),)


SHAPE = ShapeKind("cylinder", Cylinder)
