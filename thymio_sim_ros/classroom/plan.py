"""A playground seen from above as JSON, for the small pictures of the teacher's page. Pure."""

from __future__ import annotations

from typing import Any

from thymio_sim_ros.sim.model.geometry import Point
from thymio_sim_ros.sim.model.primitives import Color, Disc, Print, Solid
from thymio_sim_ros.sim.playground.reader import Playground

__all__ = ["plan_of"]

_MAX_MARKS = 400
"""Patches of paint that are drawn; a picture of 200 pixels shows no more."""
_PICTURE: Color = (0.6, 0.58, 0.55)
"""A picture on the ground is drawn in gray: the plan has no images."""


def plan_of(playground: Playground) -> dict[str, Any]:
    """Title, bounds [left, bottom, right, top] in m, patches and walls in the order in which they are drawn.

    A patch is `[color, [x, y, …]]`. A solid has `name`, `color` and either `points` in its own frame or `radius`, its
    `pose` [x, y, yaw], and `moves` if it is not always there.
    """
    floors = [[_hex(floor.color), _flat(floor.vertices)] for floor in playground.floors]
    marks = [
        [_hex(_PICTURE if isinstance(mark, Print) else mark.color), _flat(mark.vertices)]
        for mark in playground.paints[:_MAX_MARKS]
    ]
    return {
        "title": playground.title,
        "titles": {code: text.title for code, text in playground.translations},
        "bounds": _bounds(playground),
        "patches": [*floors, *marks],
        "solids": [_solid(solid) for solid in playground.solids],
    }


def _solid(solid: Solid) -> dict[str, Any]:
    shape: dict[str, Any] = (
        {"radius": _rounded(solid.outline.radius_m)}
        if isinstance(solid.outline, Disc)
        else {"points": _flat(solid.outline.vertices)}
    )
    pose = [_rounded(value) for value in (solid.pose.x_m, solid.pose.y_m, solid.pose.yaw_rad)]
    return {"name": solid.name, "color": _hex(solid.color), "pose": pose, "moves": not solid.is_fixed, **shape}


def _bounds(playground: Playground) -> list[float]:
    points = [point for floor in playground.floors for point in floor.vertices]
    points += [point for solid in playground.solids for point in solid.vertices]
    points += [(robot.x_m + side, robot.y_m + side) for robot in playground.robots for side in (-0.15, 0.15)]
    xs, ys = zip(*(points or [(-0.5, -0.5), (0.5, 0.5)]), strict=True)
    return [_rounded(value) for value in (min(xs), min(ys), max(xs), max(ys))]


def _flat(points: tuple[Point, ...]) -> list[float]:
    return [_rounded(value) for point in points for value in point]


def _rounded(value: float) -> float:
    return round(value, 3)


def _hex(color: Color) -> str:
    return "#" + "".join(f"{round(255 * part):02x}" for part in color)
