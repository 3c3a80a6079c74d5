"""Tests whether a robot or object can be placed: footprints and their overlap."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.model.geometry import Point, Pose, convex_hulls_overlap, disc_overlaps_hull
from thymio_sim_ros.sim.model.primitives import Disc, Solid
from thymio_sim_ros.sim.model.spatial_grid import Bounds, SpatialGrid

__all__ = ["Footprint", "Occupied", "PlacementError", "footprint_of", "footprint_of_robot"]

_HULL = robot_constants.hull()


class PlacementError(ThymioSimError, ValueError):
    """A robot or object, `thing`, cannot be placed: the position is occupied, or without ground; the text says why."""

    def __init__(self, thing: str, pose: Pose, reason: str) -> None:
        super().__init__(f"'{thing}' cannot be placed at {pose.x_m:.3f}, {pose.y_m:.3f} m: {reason}")
        self.thing = thing


@dataclass(frozen=True, slots=True)
class Footprint:
    """The area that a robot or solid covers, in the world's frame: a convex polygon, or a disc without vertices."""

    name: str
    middle: Point
    radius_m: float
    vertices: tuple[Point, ...] = ()

    @property
    def bounds(self) -> Bounds:
        """Left, bottom, right, top; exact for a disc."""
        (x, y), radius = self.middle, self.radius_m
        return x - radius, y - radius, x + radius, y + radius

    def overlaps(self, other: Footprint) -> bool:
        """Whether both overlap by more than an edge."""
        if math.dist(self.middle, other.middle) >= self.radius_m + other.radius_m:
            return False
        if not self.vertices:
            return not other.vertices or disc_overlaps_hull(self.middle, self.radius_m, other.vertices)
        if not other.vertices:
            return disc_overlaps_hull(other.middle, other.radius_m, self.vertices)
        return convex_hulls_overlap(self.vertices, other.vertices)


def footprint_of(solid: Solid) -> Footprint:
    """The footprint of a solid at its pose."""
    vertices = () if isinstance(solid.outline, Disc) else solid.vertices
    return Footprint(solid.name, (solid.pose.x_m, solid.pose.y_m), solid.outline.reach_m, vertices)


def footprint_of_robot(name: str, pose: Pose) -> Footprint:
    """The footprint of a robot at a pose."""
    return Footprint(name, (pose.x_m, pose.y_m), robot_constants.HULL_RADIUS_M, pose.place_all(_HULL))


class Occupied:
    """Footprints in a spatial grid."""

    def __init__(self, footprints: Iterable[Footprint] = ()) -> None:
        self._squares: SpatialGrid[Footprint] = SpatialGrid()
        for footprint in footprints:
            self.add(footprint)

    def add(self, footprint: Footprint) -> None:
        """Add a footprint."""
        self._squares.add(footprint, footprint.bounds)

    def blocker(self, footprint: Footprint) -> str | None:
        """The name of a footprint that overlaps this one; None if there is none."""
        return next((there.name for there in self._squares.near(footprint.bounds) if there.overlaps(footprint)), None)
