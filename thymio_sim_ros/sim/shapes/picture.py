"""A picture on the ground: a printed track, a map, a sheet of grays. Paint, neither an obstacle nor a floor."""

from __future__ import annotations

from dataclasses import dataclass, field

from thymio_sim_ros.sim.formats import image_io
from thymio_sim_ros.sim.model import primitives
from thymio_sim_ros.sim.model.fields import Angle, Coordinate, Extent, Image
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Primitive
from thymio_sim_ros.sim.shapes import ShapeKind


@dataclass(frozen=True, slots=True)
class Picture:
    """A picture centered on its pose, as wide as `size_x_m`; without `size_y_m` it keeps its proportions.

    Unturned it lies as on a page: to the right is +x, upwards is +y.
    """

    image: Image = field(repr=False)
    size_x_m: Extent
    size_y_m: Extent | None = None
    x_m: Coordinate = 0.0
    y_m: Coordinate = 0.0
    yaw_rad: Angle = 0.0

    def primitives(self, name: str) -> tuple[Primitive, ...]:
        """One picture; FieldError for one that cannot be read."""
        pixels = image_io.decode(self.image, key="image", width_m=self.size_x_m)
        size_y_m = self.size_x_m * pixels.rows / pixels.columns if self.size_y_m is None else self.size_y_m
        pose = Pose(self.x_m, self.y_m, self.yaw_rad)
        return (primitives.Print(name, pose, self.size_x_m, size_y_m, pixels.columns, pixels.rows, pixels.rgba),)


SHAPE = ShapeKind("picture", Picture, sample={"size_x_m": 0.4})
