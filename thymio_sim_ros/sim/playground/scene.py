"""What there is to draw: the playground's primitives once, and an immutable snapshot whenever asked."""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.sim.model.geometry import LEVEL, Pose, Tilt
from thymio_sim_ros.sim.model.primitives import Floor, Mark, Solid, Stroke
from thymio_sim_ros.sim.playground.reader import Playground

__all__ = ["ObjectSnapshot", "RobotSnapshot", "Scene", "Snapshot"]


@dataclass(frozen=True, slots=True)
class Scene:
    """What there is at the start: solids stand on floors, paint and prints lie on them, later ones on earlier ones."""

    solids: tuple[Solid, ...]
    floors: tuple[Floor, ...]
    paints: tuple[Mark, ...]

    @classmethod
    def of(cls, playground: Playground) -> Scene:
        """The scene of a playground."""
        return cls(playground.solids, playground.floors, playground.paints)


@dataclass(frozen=True, slots=True)
class RobotSnapshot:
    """One robot: true pose and lean, wheel angles left and right, levels 0…32 of its lights by group, buttons held.

    `strokes` are what its pen drew, the oldest first.
    """

    name: str
    pose: Pose
    wheel_angles_rad: tuple[float, float]
    leds: tuple[tuple[str, tuple[int, ...]], ...]
    pressed: tuple[str, ...]
    strokes: tuple[Stroke, ...] = ()
    tilt: Tilt = LEVEL


@dataclass(frozen=True, slots=True)
class ObjectSnapshot:
    """A movable thing or a door; what has fallen off an edge is out of sight."""

    name: str
    pose: Pose
    is_fallen: bool


@dataclass(frozen=True, slots=True)
class Snapshot:
    """The world at one moment."""

    now_ns: int
    robots: tuple[RobotSnapshot, ...]
    objects: tuple[ObjectSnapshot, ...] = ()
