"""The data that viewers draw: the primitives of the playground, and snapshots of robots and objects."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from thymio_sim_ros.sim.model.geometry import LEVEL, Pose, Tilt
from thymio_sim_ros.sim.model.primitives import Floor, Mark, Solid, Stroke
from thymio_sim_ros.sim.playground.reader import Playground

__all__ = ["ObjectSnapshot", "RobotSnapshot", "Scene", "Snapshot"]


@dataclass(frozen=True, slots=True)
class Scene:
    """The scene at the start: solids stand on floors, paint and prints lie on them, later ones on earlier ones."""

    solids: tuple[Solid, ...]
    floors: tuple[Floor, ...]
    paints: tuple[Mark, ...]

    @classmethod
    def of(cls, playground: Playground) -> Scene:
        """The scene of a playground."""
        return cls(playground.solids, playground.floors, playground.paints)


@dataclass(frozen=True, slots=True)
class RobotSnapshot:
    """One robot: its true pose, tilt and height over the floor, the angles of the left and right wheel.

    `shown` holds the items of all plug-ins that declare `shows`, by name.
    """

    name: str
    pose: Pose
    wheel_angles_rad: tuple[float, float]
    shown: Mapping[str, Any] = field(default_factory=dict)
    tilt: Tilt = LEVEL
    height_m: float = 0.0

    @property
    def leds(self) -> tuple[tuple[str, tuple[int, ...]], ...]:
        """Levels 0…32 of the LEDs, by group."""
        leds: tuple[tuple[str, tuple[int, ...]], ...] = self.shown.get("leds", ())
        return leds

    @property
    def pressed(self) -> tuple[str, ...]:
        """Names of the buttons that are pressed."""
        pressed: tuple[str, ...] = self.shown.get("pressed", ())
        return pressed

    @property
    def strokes(self) -> tuple[Stroke, ...]:
        """The strokes of the pen, the oldest first."""
        strokes: tuple[Stroke, ...] = self.shown.get("strokes", ())
        return strokes


@dataclass(frozen=True, slots=True)
class ObjectSnapshot:
    """A movable object or a door; an object that has fallen off an edge is not visible."""

    name: str
    pose: Pose
    is_fallen: bool


@dataclass(frozen=True, slots=True)
class Snapshot:
    """The world at one moment."""

    now_ns: int
    robots: tuple[RobotSnapshot, ...]
    objects: tuple[ObjectSnapshot, ...] = ()
