"""Walls round a piece of ground, shared by the grounds; not a shape of its own."""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.sim.fields import Extent, Shade


@dataclass(frozen=True, slots=True)
class Walls:
    """Walls centred on the border of a ground, half of the thickness inside; the ground's color unless given."""

    height_m: Extent = 0.12
    thickness_m: Extent = 0.02
    color: Shade | None = None
