"""A box, fixed or movable."""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.sim.model import primitives
from thymio_sim_ros.sim.model.fields import (
    OBJECT_FRICTION,
    OBJECT_RESTITUTION,
    Angle,
    Coordinate,
    Extent,
    Friction,
    Mass,
    Restitution,
    Shade,
    as_color,
)
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Load, Primitive, Solid
from thymio_sim_ros.sim.shapes import ShapeKind


@dataclass(frozen=True, slots=True)
class Box:
    """A box of a size, centered on its pose; movable when it has a mass. `friction` is that with the floor."""

    x_m: Coordinate
    y_m: Coordinate
    size_x_m: Extent
    size_y_m: Extent
    height_m: Extent
    color: Shade
    yaw_rad: Angle = 0.0
    mass_kg: Mass | None = None
    friction: Friction = OBJECT_FRICTION
    restitution: Restitution = OBJECT_RESTITUTION

    def primitives(self, name: str) -> tuple[Primitive, ...]:
        """One solid."""
        outline = primitives.Box(self.size_x_m, self.size_y_m)
        pose = Pose(self.x_m, self.y_m, self.yaw_rad)
        load = None
        if self.mass_kg is not None:
            load = Load(self.mass_kg, self.friction, outline.mean_lever_m, self.restitution)
        return (Solid(name, pose, outline, self.height_m, as_color(self.color), load),)


SHAPE = ShapeKind("box", Box, sample={"size_x_m": 0.1, "size_y_m": 0.1, "height_m": 0.1, "color": "#e08a2e"})
