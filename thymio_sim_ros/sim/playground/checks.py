"""Checks of a playground as a whole: names, positions, doors, cost of the ground.

Each check raises FieldError with the key of what is wrong.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from thymio_sim_ros.sim.ground import raster
from thymio_sim_ros.sim.model.fields import FieldError, describe
from thymio_sim_ros.sim.model.primitives import Floor, Mark, Primitive, Solid, Trigger
from thymio_sim_ros.sim.playground.model import NamedShape, RobotStart
from thymio_sim_ros.sim.playground.placement import Occupied, footprint_of, footprint_of_robot

__all__ = ["check_doors", "check_ground", "check_names", "check_starts", "off_floor"]


def check_names(shapes: Iterable[NamedShape], robots: Iterable[RobotStart]) -> None:
    """Raise FieldError for a name that occurs twice."""
    seen: dict[str, str] = {}
    named = [(f"shapes[{index}]", shape.name) for index, shape in enumerate(shapes)]
    named += [(f"robots[{index}]", robot.name) for index, robot in enumerate(robots)]
    for key, name in named:
        if name in seen:
            raise FieldError(f"{key}.name", f"'{name}', the name of {seen[name]}", "a unique name")
        seen[name] = key


def check_ground(floors: Sequence[Floor], paints: Sequence[Mark]) -> None:
    """Raise FieldError for a ground that takes too long to rasterize."""
    cost = raster.cost(floors, paints)
    if cost > raster.MAX_COST:
        found = f"a ground that takes {cost / raster.MAX_COST:.3g} times the allowed time to paint"
        raise FieldError("shapes", found, "fewer or smaller floors and images, or a smaller ground")


def check_starts(robots: Iterable[RobotStart], solids: Iterable[Solid]) -> None:
    """Raise FieldError for a robot that starts inside a solid or another robot."""
    occupied = Occupied(map(footprint_of, solids))
    for index, robot in enumerate(robots):
        footprint = footprint_of_robot(robot.name, robot.pose)
        blocker = occupied.blocker(footprint)
        if blocker is not None:
            raise FieldError(f"robots[{index}]", f"'{robot.name}' inside '{blocker}'", "a free position")
        occupied.add(footprint)


def off_floor(robots: tuple[RobotStart, ...], solids: Iterable[Solid], floors: tuple[Floor, ...]) -> list[str]:
    """Notes on robots and objects that start beside the floor: allowed, as they can be moved, but hardly meant.

    Without any ground there is no edge either, and nothing falls (sim/ground/floor_support.py).
    """
    if not floors:
        return []
    starts = [(f"robots[{index}]: '{robot.name}'", robot.x_m, robot.y_m) for index, robot in enumerate(robots)]
    starts += [
        (f"shapes: '{solid.name}'", solid.pose.x_m, solid.pose.y_m) for solid in solids if solid.load is not None
    ]
    return [
        f"{who} starts where there is no floor"
        for who, x, y in starts
        if not any(floor.holds((x, y)) for floor in floors)
    ]


def check_doors(shapes: tuple[NamedShape, ...], primitives: Iterable[Primitive]) -> None:
    """Raise FieldError for a pressure plate whose door does not exist."""
    doors = [primitive.name for primitive in primitives if isinstance(primitive, Solid) and primitive.slide is not None]
    keys = {shape.name: f"shapes[{index}].door" for index, shape in enumerate(shapes)}
    for primitive in primitives:
        if isinstance(primitive, Trigger) and primitive.door not in doors:
            expected = (
                "one of the doors " + ", ".join(doors) if doors else "the name of a door; the playground has none"
            )
            raise FieldError(keys[primitive.name], describe(primitive.door), expected)
