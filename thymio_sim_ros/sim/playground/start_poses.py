"""Moves robots of other simulators that start inside something to the nearest free position.

Playgrounds made for simulators that push robots out of things start some of them there. The search is deterministic:
rings of growing radius around the place that was asked for, each begun in the direction of +x.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import islice

from thymio_sim_ros.sim.model.geometry import Point
from thymio_sim_ros.sim.model.primitives import Floor, Solid
from thymio_sim_ros.sim.playground.model import RobotStart
from thymio_sim_ros.sim.playground.placement import Occupied, footprint_of, footprint_of_robot

__all__ = ["set_free"]

STEP_M = 0.01
"""Distance between rings, and between the places on a ring."""
MOST_PLACES = 20_000
"""Places that are tried for one robot: rings up to 0.8 m."""
MOST_ROBOTS = 20
"""Robots that are set free in one playground; more hardly come from a simulator."""


def set_free(
    robots: Sequence[RobotStart], solids: Iterable[Solid], floors: Sequence[Floor]
) -> tuple[tuple[RobotStart, ...], tuple[str, ...]]:
    """The robots at free positions, and a note about each that was moved.

    A robot keeps its heading, and its place if no free one is found; robots that stand free are never moved.
    """
    occupied = Occupied(map(footprint_of, solids))
    blockers: dict[int, str] = {}
    for index, robot in enumerate(robots):
        footprint = footprint_of_robot(robot.name, robot.pose)
        blocker = occupied.blocker(footprint)
        if blocker is None:
            occupied.add(footprint)
        else:
            blockers[index] = blocker
    freed, notes = list(robots), []
    for index, blocker in islice(blockers.items(), MOST_ROBOTS):
        robot = robots[index]
        moved = _nearest(robot, occupied, floors)
        if moved is None:
            continue
        freed[index] = moved
        occupied.add(footprint_of_robot(moved.name, moved.pose))
        place = f"{moved.x_m:.3f}, {moved.y_m:.3f} m"
        notes.append(f"robots[{index}]: '{robot.name}' starts inside '{blocker}', moved to {place}")
    return tuple(freed), tuple(notes)


def _nearest(robot: RobotStart, occupied: Occupied, floors: Sequence[Floor]) -> RobotStart | None:
    """The robot at the nearest free position on a floor; None if there is none near."""
    for x_m, y_m in islice(_places((robot.x_m, robot.y_m)), MOST_PLACES):
        if floors and not any(floor.holds((x_m, y_m)) for floor in floors):
            continue
        moved = replace(robot, x_m=x_m, y_m=y_m)
        if occupied.blocker(footprint_of_robot(moved.name, moved.pose)) is None:
            return moved
    return None


def _places(middle: Point) -> Iterator[Point]:
    """Positions around a point, the nearest first, rounded to tenths of a millimeter."""
    ring = 0
    while True:
        ring += 1
        radius = ring * STEP_M
        count = max(8, math.ceil(2 * math.pi * radius / STEP_M))
        for step in range(count):
            angle = 2 * math.pi * step / count
            yield round(middle[0] + radius * math.cos(angle), 4), round(middle[1] + radius * math.sin(angle), 4)
