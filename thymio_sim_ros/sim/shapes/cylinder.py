"""A cylinder, fixed or movable."""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.sim.model.fields import (
    OBJECT_FRICTION,
    OBJECT_RESTITUTION,
    Coordinate,
    Extent,
    Friction,
    Mass,
    Restitution,
    Shade,
    as_color,
)
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Disc, Load, Primitive, Solid
from thymio_sim_ros.sim.shapes import ShapeKind


@dataclass(frozen=True, slots=True)
class Cylinder:
    """An upright cylinder; movable when it has a mass. `friction` is that with the floor."""

    x_m: Coordinate
    y_m: Coordinate
    radius_m: Extent
    height_m: Extent
    color: Shade
    mass_kg: Mass | None = None
    friction: Friction = OBJECT_FRICTION
    restitution: Restitution = OBJECT_RESTITUTION

    def primitives(self, name: str) -> tuple[Primitive, ...]:
        """One solid."""
        pose, outline = Pose(self.x_m, self.y_m, 0.0), Disc(self.radius_m)
        load = None
        if self.mass_kg is not None:
            load = Load(self.mass_kg, self.friction, outline.mean_lever_m, self.restitution)
        return (Solid(name, pose, outline, self.height_m, as_color(self.color), load),)


SHAPE = ShapeKind("cylinder", Cylinder, sample={"radius_m": 0.04, "height_m": 0.12, "color": "#3f88c5"})
