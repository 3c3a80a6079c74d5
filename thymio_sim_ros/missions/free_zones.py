"""Whether a robot can be in a zone: one that lies outside of the playground or in a wall is a mistake."""

from __future__ import annotations

from collections.abc import Mapping

from thymio_sim_ros.missions.zones import Zone
from thymio_sim_ros.sim.model.fields import FieldError
from thymio_sim_ros.sim.model.robot_constants import HULL_WIDTH_M
from thymio_sim_ros.sim.playground.placement import Footprint, Occupied, footprint_of
from thymio_sim_ros.sim.playground.reader import Playground

__all__ = ["check_zones"]

_STEPS = 24
"""Places along each side of a zone that are tried."""


def check_zones(zones: Mapping[str, Zone], playground: Playground) -> None:
    """Raise FieldError for a zone in which the center of a robot cannot be: no ground, or fixed solids everywhere."""
    fixed = Occupied(footprint_of(solid) for solid in playground.solids if solid.load is None and solid.slide is None)
    for name, zone in zones.items():
        places = [(x, y) for x, y in _places(zone) if zone.contains(x, y)]
        on_ground = [
            place for place in places if not playground.floors or any(floor.holds(place) for floor in playground.floors)
        ]
        if not on_ground:
            raise FieldError(f"zones.{name}", "a zone without ground", "one inside of the playground")
        blockers = [fixed.blocker(Footprint("", place, HULL_WIDTH_M / 2)) for place in on_ground]
        if None not in blockers:
            raise FieldError(f"zones.{name}", f"a zone inside of '{blockers[0]}'", "one that a robot can reach")


def _places(zone: Zone) -> list[tuple[float, float]]:
    left, bottom, right, top = zone.bounds
    across = [left + (right - left) * step / _STEPS for step in range(_STEPS + 1)]
    up = [bottom + (top - bottom) * step / _STEPS for step in range(_STEPS + 1)]
    return [(x, y) for x in across for y in up]
