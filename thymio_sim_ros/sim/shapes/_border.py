"""Walls round a piece of ground, shared by the grounds; not a shape of its own."""

from __future__ import annotations

import math
from dataclasses import dataclass

from thymio_sim_ros.sim.model.fields import Extent, Shade


@dataclass(frozen=True, slots=True)
class Walls:
    """Walls centered on the border of a ground, half of the thickness inside; the ground's color unless given."""

    height_m: Extent = 0.12
    thickness_m: Extent = 0.02
    color: Shade | None = None


_SIDES = ("east", "north-east", "north", "north-west", "west", "south-west", "south", "south-east")
_USUAL_GROUND = "ground"


def wall_name(ground: str, yaw_rad: float, eighths: int) -> str:
    """The name of a wall by its direction, in eighths of a turn from the x axis of a ground: "north wall".

    In the world x is east; the name of a ground that is not simply called so comes first.
    """
    side = _SIDES[(eighths + math.floor(yaw_rad / (math.pi / 4) + 0.5)) % len(_SIDES)]
    return f"{side} wall" if ground == _USUAL_GROUND else f"{ground} {side} wall"
