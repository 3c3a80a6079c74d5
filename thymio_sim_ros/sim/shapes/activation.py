"""A block with an area that opens a door while a robot is in it (docs/spec/playground-formats.md section 1.2)."""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.sim.model import primitives
from thymio_sim_ros.sim.model.fields import Angle, Area, Coordinate, Extent, Name, Shade, as_color
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Primitive, Solid, Trigger
from thymio_sim_ros.sim.shapes import ShapeKind


@dataclass(frozen=True, slots=True)
class Activation:
    """A low block, and a polygon of points relative to it; `door` is the name of a door."""

    x_m: Coordinate
    y_m: Coordinate
    size_x_m: Extent
    size_y_m: Extent
    area_m: Area
    door: Name
    height_m: Extent = 0.06
    color: Shade = "#ff0000"
    yaw_rad: Angle = 0.0

    def primitives(self, name: str) -> tuple[Primitive, ...]:
        """One solid and one trigger."""
        pose = Pose(self.x_m, self.y_m, self.yaw_rad)
        outline = primitives.Box(self.size_x_m, self.size_y_m)
        return (
            Solid(name, pose, outline, self.height_m, as_color(self.color)),
            Trigger(name, pose.place_all(self.area_m), self.door),
        )


SHAPE = ShapeKind(
    "activation",
    Activation,
    sample={
        "size_x_m": 0.06,
        "size_y_m": 0.03,
        "area_m": ((-0.1, -0.02), (0.1, -0.02), (0.1, 0.18), (-0.1, 0.18)),
    },
)
