"""What every shape is made of: solids that stop robots and reflect light, floors, paint and pictures on floors.

Shapes give primitives; physics, sensors, scene and editor know nothing else (architecture section 14).
Colors are red, green, blue from 0 to 1.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from thymio_sim_ros.sim.geometry import Point, Pose

__all__ = [
    "Box",
    "Color",
    "Disc",
    "Floor",
    "Mark",
    "Outline",
    "Paint",
    "Polygon",
    "Primitive",
    "Print",
    "Solid",
    "Stroke",
]

Color = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Box:
    """Outline: a rectangle centred on its pose."""

    size_x_m: float
    size_y_m: float

    @property
    def vertices(self) -> tuple[Point, ...]:
        """Corners, counter-clockwise, in the solid's frame."""
        x, y = self.size_x_m / 2, self.size_y_m / 2
        return ((-x, -y), (x, -y), (x, y), (-x, y))


@dataclass(frozen=True, slots=True)
class Disc:
    """Outline: a circle centred on its pose."""

    radius_m: float


@dataclass(frozen=True, slots=True)
class Polygon:
    """Outline: a convex polygon, counter-clockwise, in the solid's frame."""

    vertices: tuple[Point, ...]


Outline = Box | Disc | Polygon


@dataclass(frozen=True, slots=True)
class Solid:
    """A thing that stands on the ground: outline, height, color. `name` is its shape's, and may occur again."""

    name: str
    pose: Pose
    outline: Outline
    height_m: float
    color: Color

    @property
    def vertices(self) -> tuple[Point, ...]:
        """Corners in the world's frame; none for a disc."""
        return () if isinstance(self.outline, Disc) else self.pose.place_all(self.outline.vertices)


@dataclass(frozen=True, slots=True)
class Floor:
    """A convex piece of ground, counter-clockwise in the world's frame; where there is none a robot falls."""

    name: str
    vertices: tuple[Point, ...]
    color: Color


@dataclass(frozen=True, slots=True)
class Paint:
    """A convex patch of color on the ground, in the world's frame; later paint covers earlier paint."""

    name: str
    vertices: tuple[Point, ...]
    color: Color


@dataclass(frozen=True, slots=True)
class Print:
    """A picture on the ground, centred on its pose; its first row is the far side (+y), its first column -x.

    `rgba` holds red, green, blue, opacity (0…255) of each pixel, row by row; the ground shows through what is not
    opaque. Like paint it covers what was painted before.
    """

    name: str
    pose: Pose
    size_x_m: float
    size_y_m: float
    columns: int
    rows: int
    rgba: bytes = field(repr=False)

    @property
    def vertices(self) -> tuple[Point, ...]:
        """Corners in the world's frame, counter-clockwise from the lower left one of the picture."""
        return self.pose.place_all(Box(self.size_x_m, self.size_y_m).vertices)


Mark = Paint | Print
"""What lies on floors and makes them dark or bright."""

Primitive = Solid | Floor | Paint | Print


@dataclass(frozen=True, slots=True)
class Stroke:
    """A line that a pen drew, as one sees it: its points in the world's frame."""

    color: Color
    width_m: float
    points: tuple[Point, ...]
