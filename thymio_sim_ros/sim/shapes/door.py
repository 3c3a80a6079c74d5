"""A door that slides between two places while a robot is on a pressure plate of it.

Source: docs/spec/playground-formats.md section 1.2.
"""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.sim.model import primitives
from thymio_sim_ros.sim.model.fields import Angle, Coordinate, Duration, Extent, Shade, as_color
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Primitive, Slide, Solid
from thymio_sim_ros.sim.shapes import ShapeKind


@dataclass(frozen=True, slots=True)
class Door:
    """A box that starts closed and takes `move_s` from one place to the other, slowly at both ends."""

    closed_x_m: Coordinate
    closed_y_m: Coordinate
    opened_x_m: Coordinate
    opened_y_m: Coordinate
    size_x_m: Extent
    size_y_m: Extent
    height_m: Extent
    move_s: Duration
    color: Shade
    yaw_rad: Angle = 0.0

    def primitives(self, name: str) -> tuple[Primitive, ...]:
        """One solid that slides."""
        closed = Pose(self.closed_x_m, self.closed_y_m, self.yaw_rad)
        slide = Slide(Pose(self.opened_x_m, self.opened_y_m, self.yaw_rad), self.move_s)
        outline = primitives.Box(self.size_x_m, self.size_y_m)
        return (Solid(name, closed, outline, self.height_m, as_color(self.color), slide=slide),)


SHAPE = ShapeKind(
    "door",
    Door,
    sample={
        "opened_x_m": 0.2,
        "size_x_m": 0.2,
        "size_y_m": 0.02,
        "height_m": 0.1,
        "move_s": 2.0,
        "color": "#3f88c5",
    },
)
