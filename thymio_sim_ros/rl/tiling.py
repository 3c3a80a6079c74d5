"""Copies of a playground in one world, out of each other's reach: many robots cost little more than one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from thymio_sim_ros.rl.errors import TaskError
from thymio_sim_ros.sim.model.geometry import Point, Pose
from thymio_sim_ros.sim.model.primitives import Disc, Floor, Mark, Print
from thymio_sim_ros.sim.playground.model import Playground

__all__ = ["tiled"]

GAP_M = 0.4
"""Distance between two copies: more than the range of the proximity sensors on both sides."""


def tiled(playground: Playground, count: int) -> tuple[Playground, tuple[Point, ...]]:
    """A playground with this many copies of another in rows, without robots, and the offset of each copy, m.

    Raises TaskError if there are several and the playground has no floor, on which robots stay in their copy, or
    something that moves, which would be common to all episodes of a copy.
    """
    if count == 1:
        return replace(playground, robots=()), ((0.0, 0.0),)
    moving = [solid.name for solid in playground.solids if not solid.is_fixed]
    if moving or playground.triggers or not playground.floors:
        found = f"'{moving[0]}', which moves" if moving else "a pressure plate" if playground.triggers else "no floor"
        raise TaskError(
            f"playground '{playground.name}': found {found}, expected a floor and fixed objects for several copies in "
            "one world; use gymnasium.make_vec(…, vectorization_mode='async')"
        )
    width, height = _size(playground)
    columns = math.ceil(math.sqrt(count))
    places = ((number % columns, number // columns) for number in range(count))
    offsets = tuple((column * (width + GAP_M), row * (height + GAP_M)) for column, row in places)
    tiles = Playground(
        name=playground.name,
        title=playground.title,
        description=playground.description,
        shapes=(),
        robots=(),
        solids=tuple(solid.at(_shifted(solid.pose, by)) for by in offsets for solid in playground.solids),
        floors=tuple(_floor(floor, by) for by in offsets for floor in playground.floors),
        paints=tuple(_mark(mark, by) for by in offsets for mark in playground.paints),
    )
    return tiles, offsets


def _size(playground: Playground) -> tuple[float, float]:
    """Width and height of the content of a playground, m."""
    points = [point for item in (*playground.floors, *playground.paints) for point in item.vertices]
    for solid in playground.solids:
        reach = solid.outline.reach_m
        middle = (solid.pose.x_m, solid.pose.y_m)
        ends = ((middle[0] - reach, middle[1] - reach), (middle[0] + reach, middle[1] + reach))
        points += ends if isinstance(solid.outline, Disc) else solid.vertices
    xs, ys = zip(*points, strict=True)
    return max(xs) - min(xs), max(ys) - min(ys)


def _shifted(pose: Pose, by: Point) -> Pose:
    return Pose(pose.x_m + by[0], pose.y_m + by[1], pose.yaw_rad)


def _moved(vertices: Sequence[Point], by: Point) -> tuple[Point, ...]:
    return tuple((x + by[0], y + by[1]) for x, y in vertices)


def _floor(floor: Floor, by: Point) -> Floor:
    return replace(floor, vertices=_moved(floor.vertices, by))


def _mark(mark: Mark, by: Point) -> Mark:
    if isinstance(mark, Print):
        return replace(mark, pose=_shifted(mark.pose, by))
    return replace(mark, vertices=_moved(mark.vertices, by))
