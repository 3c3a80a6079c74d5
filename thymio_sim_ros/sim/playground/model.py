"""A playground that has been read, as frozen values, and the error of one that is rejected."""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.sim.model.fields import Angle, Coordinate, Name, PenWidth, Shade, Text
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Floor, Mark, Solid, Trigger
from thymio_sim_ros.sim.shapes import Shape

__all__ = ["Headline", "NamedShape", "PenStart", "Playground", "PlaygroundError", "RobotStart", "Translation"]


class PlaygroundError(ThymioSimError):
    """A playground that is refused: file, path of the key, what was found there, what was expected."""

    def __init__(self, path: str, key: str, found: str, expected: str) -> None:
        where = f"{path}: {key}" if key else path
        super().__init__(f"{where}: found {found}, expected {expected}")
        self.path = path
        self.key = key
        self.found = found
        self.expected = expected


@dataclass(frozen=True, slots=True)
class PenStart:
    """A pen that a robot has at the start."""

    color: Shade = "#000000"
    width_m: PenWidth = 0.003
    down: bool = True


@dataclass(frozen=True, slots=True)
class RobotStart:
    """A robot, where it starts, and the pen that it has then, if any."""

    name: Name
    x_m: Coordinate
    y_m: Coordinate
    yaw_rad: Angle = 0.0
    pen: PenStart | None = None

    @property
    def pose(self) -> Pose:
        """The start as a pose."""
        return Pose(self.x_m, self.y_m, self.yaw_rad)


@dataclass(frozen=True, slots=True)
class NamedShape:
    """One shape of the file: its kind's name, its own name, its fields."""

    kind: str
    name: str
    shape: Shape


@dataclass(frozen=True, slots=True)
class Translation:
    """Title and description in another language."""

    title: Text
    description: Text = ""


@dataclass(frozen=True, slots=True)
class Headline:
    """The entry of a playground in a list; translations by language code."""

    title: str
    description: str
    translations: tuple[tuple[str, Translation], ...]


@dataclass(frozen=True, slots=True)
class Playground:
    """A checked playground.

    Invariant: names are unique, no robot starts inside a solid or another robot, triggers name doors.
    """

    name: str
    title: str
    description: str
    shapes: tuple[NamedShape, ...]
    robots: tuple[RobotStart, ...]
    solids: tuple[Solid, ...]
    floors: tuple[Floor, ...]
    paints: tuple[Mark, ...]
    translations: tuple[tuple[str, Translation], ...] = ()
    """By language code, in the order of the file; `title` and `description` are English."""
    triggers: tuple[Trigger, ...] = ()
    notes: tuple[str, ...] = ()
    """Remarks for the user: parts that a converted file cannot express, probable mistakes."""
