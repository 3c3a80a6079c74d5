"""The U of the thesis: three boxes, open to +x (docs/spec/playground-formats.md section 2: uShapes)."""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.sim.model.fields import Angle, Coordinate, Extent, Shade, as_color
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Box, Primitive, Solid
from thymio_sim_ros.sim.shapes import ShapeKind

_PARTS = (
    ((0.0, -4.0), (8.0, 1.0)),
    ((-3.0, 0.0), (2.0, 7.0)),
    ((2.0, 4.0), (12.0, 2.0)),
)
"""Center and size of the boxes in units of `unit_m`; one arm is longer and thicker, as in the original."""


@dataclass(frozen=True, slots=True)
class UFigure:
    """A U drawn in units of `unit_m`: about 12 by 9.5 units."""

    unit_m: Extent
    height_m: Extent
    color: Shade
    x_m: Coordinate = 0.0
    y_m: Coordinate = 0.0
    yaw_rad: Angle = 0.0

    def primitives(self, name: str) -> tuple[Primitive, ...]:
        """Three solids: the thin arm, the back, the thick arm."""
        pose = Pose(self.x_m, self.y_m, self.yaw_rad)
        unit, color = self.unit_m, as_color(self.color)
        return tuple(
            Solid(
                name,
                Pose(*pose.place((x * unit, y * unit)), self.yaw_rad),
                Box(size_x * unit, size_y * unit),
                self.height_m,
                color,
            )
            for (x, y), (size_x, size_y) in _PARTS
        )


SHAPE = ShapeKind("u_figure", UFigure, sample={"unit_m": 0.03, "height_m": 0.12, "color": "#9fa3bd"})
