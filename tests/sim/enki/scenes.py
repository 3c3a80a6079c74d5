"""Measured scenes of the reference simulator, and the same scenes in worlds of ours."""

from __future__ import annotations

import gzip
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

from tests.sim.builders import GRAY, make
from thymio_sim_ros.sim.commands import MotorTargets
from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.model.primitives import Disc, Floor, Polygon, Solid
from thymio_sim_ros.sim.playground.reader import RobotStart
from thymio_sim_ros.sim.world import World

SHIPPED = Path(__file__).parents[2] / "data" / "enki"
FILES = ("prox", "ground", "motion", "collision", "playground-live")
PITCH_M = 4.0
"""Distance of the scenes in a world. A robot drives 1.2 m at most."""
Scene = dict[str, Any]


def is_set(folder: Path) -> bool:
    """Whether a folder holds measured scenes."""
    return any(_path(folder, name) for name in FILES)


@cache
def load(name: str, folder: Path = SHIPPED) -> tuple[Scene, ...]:
    """The scenes of a file of a set, none if the set lacks it; each knows its `family` and the file's `meta`."""
    path = _path(folder, name)
    if path is None:
        return ()
    data = json.loads(gzip.decompress(path.read_bytes()) if path.suffix == ".gz" else path.read_bytes())
    families = data.get("families", {"live": data.get("entries", [])})
    return tuple(
        {**scene, "family": family, "meta": data["meta"]} for family, scenes in families.items() for scene in scenes
    )


def world_of(scenes: Sequence[Mapping[str, Any]], **options: Any) -> World:
    """The world of scenes that all have walls around them or all have none, each in a place of its own (`place_of`).

    Robots are in their places even where a start would be refused.
    """
    solids: list[Solid] = []
    robots: list[RobotStart] = []
    floors: list[Floor] = []
    for number, scene in enumerate(scenes):
        x_m, y_m = place_of(number)
        built = make(_shapes(scene, number, x_m, y_m), [])
        floors += built.floors
        solids += built.solids
        robots += [
            RobotStart(f"robot{number}_{index}", x_m + start["x"], y_m + start["y"], start["theta"])
            for index, start in enumerate(scene["robots"])
        ]
    solids = [
        replace(solid, load=replace(solid.load, lever_m=_lever(solid))) if solid.load is not None else solid
        for solid in solids
    ]
    playground = replace(make([], []), floors=tuple(floors), solids=tuple(solids), robots=tuple(robots))
    return World(playground, **options)


def place_of(number: int) -> tuple[float, float]:
    """The origin of a scene of a world: out of sight and reach of all others."""
    row, column = divmod(number, 40)
    return (column - 20) * PITCH_M, (row - 20) * PITCH_M


def play(scene: Scene, *, runs: int) -> list[list[tuple[float, ...]]]:
    """Run a scene so many times with different noise, in one world.

    Each run has a row every `every` of the scene's steps, in the order of its `mean`: robots, then things; x, y, yaw.
    The reference lets a target move the robot two of its steps later.
    """
    world = world_of([scene] * runs, periods_ns={})
    ticks = round(scene["dt"] / 0.01)
    commands = {ticks * (command["step"] + 2): command for command in scene["commands"]}
    drivers = list(world.robots)[:: len(scene["robots"])]
    rows = [_rows(world, runs)]
    for tick in range(ticks * scene["every"] * (len(scene["mean"]) - 1)):
        if tick in commands:
            targets = commands[tick]
            for driver in drivers:
                world.post(driver, MotorTargets(int(targets["left_target"]), int(targets["right_target"])))
        world.step()
        if (tick + 1) % (ticks * scene["every"]) == 0:
            rows.append(_rows(world, runs))
    return [list(run) for run in zip(*rows, strict=True)]


def mean_rows(runs: Sequence[list[tuple[float, ...]]]) -> list[tuple[float, ...]]:
    """The mean of each row over several runs."""
    return [
        tuple(math.fsum(values) / len(runs) for values in zip(*rows, strict=True)) for rows in zip(*runs, strict=True)
    ]


def _rows(world: World, runs: int) -> list[tuple[float, ...]]:
    """A row of each run."""
    snapshot = world.snapshot()
    robots, things = len(snapshot.robots) // runs, len(snapshot.objects) // runs
    return [
        tuple(
            _values(
                [
                    *snapshot.robots[run * robots : (run + 1) * robots],
                    *snapshot.objects[run * things : (run + 1) * things],
                ],
                *place_of(run),
            )
        )
        for run in range(runs)
    ]


def _values(bodies: Sequence[Any], x_m: float, y_m: float) -> Iterator[float]:
    for body in bodies:
        yield from (body.pose.x_m - x_m, body.pose.y_m - y_m, body.pose.yaw_rad)


def _shapes(scene: Mapping[str, Any], number: int, x_m: float, y_m: float) -> list[dict[str, Any]]:
    """The walls and things of a scene whose origin is in a place."""
    shapes: list[dict[str, Any]] = []
    if scene["world"]["kind"] == "square":
        width, height = scene["world"]["width"], scene["world"]["height"]
        size = {"size_x_m": width + 0.02, "size_y_m": height + 0.02}
        shapes.append({"kind": "rectangle", "x_m": width / 2, "y_m": height / 2, **size, "color": GRAY})
        shapes[0]["walls"] = {"height_m": 1.0}
    shapes += [_thing(thing, f"thing{number}_{index}") for index, thing in enumerate(scene["objects"])]
    return [{**shape, "x_m": x_m + shape["x_m"], "y_m": y_m + shape["y_m"]} for shape in shapes]


def _thing(thing: Mapping[str, Any], name: str) -> dict[str, Any]:
    """A thing of a scene. The reference takes g as 9.81 cm/s² and multiplies elasticities, 0.9 being the robot's."""
    shape = {"kind": thing["kind"], "name": name, "x_m": thing["x"], "y_m": thing["y"], "color": GRAY}
    shape["height_m"] = thing["height"]
    if thing["kind"] == "box":
        shape |= {"yaw_rad": thing["theta"], "size_x_m": thing["size_x"], "size_y_m": thing["size_y"]}
    else:
        shape["radius_m"] = thing["radius"]
    if thing.get("mass") is not None:
        shape["mass_kg"] = thing["mass"] * robot_constants.MASS_KG / 200
        shape["friction"] = thing.get("dry_friction", 0.25) / 100
        shape["restitution"] = thing.get("elasticity", 0.9) * 0.9
    return shape


def _lever(solid: Solid) -> float:
    """The lever with which turning slows by the friction times 9.81 rad/s², as it does in the reference."""
    outline = solid.outline
    assert not isinstance(outline, Polygon)
    if isinstance(outline, Disc):
        return outline.radius_m**2 / 2 * 100
    return (outline.size_x_m**2 + outline.size_y_m**2) / 12 * 100


def _path(folder: Path, name: str) -> Path | None:
    """The file of a set, plain or compressed, or None."""
    return next((path for end in ("", ".gz") if (path := folder / f"enki-{name}.json{end}").is_file()), None)
