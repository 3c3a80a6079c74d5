"""The parts of every shape: solids that stop robots and reflect light, floors, paint and pictures on floors.

Shapes give primitives; physics, sensors, scene and editor know nothing else (docs/architecture.md, "Decisions").
Colors are red, green, blue from 0 to 1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

from thymio_sim_ros.sim.model.geometry import Point, Pose

__all__ = [
    "Box",
    "Color",
    "Disc",
    "Drawable",
    "Floor",
    "Load",
    "Mark",
    "Outline",
    "Paint",
    "Polygon",
    "Primitive",
    "Print",
    "Slide",
    "Solid",
    "Stroke",
    "Trigger",
]

Color = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Box:
    """Outline: a rectangle centered on its pose."""

    size_x_m: float
    size_y_m: float

    @property
    def vertices(self) -> tuple[Point, ...]:
        """Corners, counter-clockwise, in the solid's frame."""
        x, y = self.size_x_m / 2, self.size_y_m / 2
        return ((-x, -y), (x, -y), (x, y), (-x, y))

    @property
    def reach_m(self) -> float:
        """No point is farther from the middle."""
        return math.hypot(self.size_x_m, self.size_y_m) / 2

    @property
    def mean_lever_m(self) -> float:
        """Mean distance of its points from the middle."""
        x, y = self.size_x_m / 2, self.size_y_m / 2
        half = math.hypot(x, y)
        sides = x * x / (6 * y) * math.asinh(y / x) + y * y / (6 * x) * math.asinh(x / y)
        return half / 3 + sides


@dataclass(frozen=True, slots=True)
class Disc:
    """Outline: a circle centered on its pose."""

    radius_m: float

    @property
    def reach_m(self) -> float:
        """No point is farther from the middle."""
        return self.radius_m

    @property
    def mean_lever_m(self) -> float:
        """Mean distance of its points from the middle."""
        return self.radius_m * 2 / 3


@dataclass(frozen=True, slots=True)
class Polygon:
    """Outline: a convex polygon, counter-clockwise, in the solid's frame."""

    vertices: tuple[Point, ...]

    @property
    def reach_m(self) -> float:
        """No point is farther from the frame's origin."""
        return max(math.hypot(x, y) for x, y in self.vertices)


Outline = Box | Disc | Polygon


@dataclass(frozen=True, slots=True)
class Load:
    """Properties of a movable solid: mass, coefficient of friction on the floor, restitution when a robot hits it.

    `lever_m` is the mean distance from its middle at which the floor holds it when it turns. `restitution` is the part
    of the speed that is left after robot and thing have met, 0…1.
    """

    mass_kg: float
    friction: float
    lever_m: float
    restitution: float = 0.0


@dataclass(frozen=True, slots=True)
class Slide:
    """Properties of a door: its position when open, and the time that opening takes."""

    opened: Pose
    duration_s: float


@dataclass(frozen=True, slots=True)
class Solid:
    """A thing that stands on the ground: outline, height, color.

    `name` is its shape's or that of a part of it, and may occur again, but only once for one with a load or a slide.
    """

    name: str
    pose: Pose
    outline: Outline
    height_m: float
    color: Color
    load: Load | None = None
    slide: Slide | None = None

    @property
    def is_fixed(self) -> bool:
        """Whether it always stays where it is."""
        return self.load is None and self.slide is None

    @property
    def vertices(self) -> tuple[Point, ...]:
        """Corners in the world's frame; none for a disc."""
        return () if isinstance(self.outline, Disc) else self.pose.place_all(self.outline.vertices)

    def at(self, pose: Pose) -> Solid:
        """The same solid at another pose."""
        return replace(self, pose=pose)


@dataclass(frozen=True, slots=True)
class Floor:
    """A convex piece of ground, counter-clockwise in the world's frame; where there is none a robot falls."""

    name: str
    vertices: tuple[Point, ...]
    color: Color

    def holds(self, point: Point) -> bool:
        """Whether a point lies on it, edges included."""
        x, y = point
        return all(
            (bx - ax) * (y - ay) - (by - ay) * (x - ax) >= -1e-9
            for (ax, ay), (bx, by) in zip(self.vertices, (*self.vertices[1:], self.vertices[0]), strict=True)
        )


@dataclass(frozen=True, slots=True)
class Paint:
    """A convex patch of color on the ground, in the world's frame; later paint covers earlier paint."""

    name: str
    vertices: tuple[Point, ...]
    color: Color


@dataclass(frozen=True, slots=True)
class Print:
    """A picture on the ground, centered on its pose; its first row is the far side (+y), its first column -x.

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
"""A primitive that lies on floors and makes them dark or bright."""


@dataclass(frozen=True, slots=True)
class Stroke:
    """A line that a pen drew, as one sees it: its points in the world's frame."""

    color: Color
    width_m: float
    points: tuple[Point, ...]


@dataclass(frozen=True, slots=True)
class Trigger:
    """An area that opens a door while the origin of any robot is in it; any polygon, in the world's frame."""

    name: str
    vertices: tuple[Point, ...]
    door: str

    @property
    def middle(self) -> Point:
        """The middle of its bounds."""
        xs, ys = zip(*self.vertices, strict=True)
        return (min(xs) + max(xs)) / 2, (min(ys) + max(ys)) / 2

    @property
    def reach_m(self) -> float:
        """No corner is farther from the middle."""
        return max(math.dist(self.middle, vertex) for vertex in self.vertices)

    def holds(self, x_m: float, y_m: float) -> bool:
        """Whether a point lies inside, by the even-odd rule."""
        inside = False
        for index, (bx, by) in enumerate(self.vertices):
            ax, ay = self.vertices[index - 1]
            if (ay > y_m) != (by > y_m) and x_m < ax + (bx - ax) * (y_m - ay) / (by - ay):
                inside = not inside
        return inside


Drawable = Solid | Floor | Paint | Print
"""A visible primitive."""

Primitive = Drawable | Trigger
