"""Small worlds for tests: playgrounds from plain data, runs of a number of seconds."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from thymio_sim_ros.sim import playground, thymio2
from thymio_sim_ros.sim.clock import TICK_NS
from thymio_sim_ros.sim.commands import Command
from thymio_sim_ros.sim.geometry import Pose
from thymio_sim_ros.sim.playground import Playground, RobotStart
from thymio_sim_ros.sim.primitives import Disc, Polygon, Solid
from thymio_sim_ros.sim.readings import Reading
from thymio_sim_ros.sim.world import StepResult, World

REPOSITORY = Path(__file__).parents[2]
PLAYGROUNDS = REPOSITORY / "playgrounds"
ENKI = REPOSITORY / "tests" / "data" / "enki"

GREY = "#808080"
FLOOR = {"kind": "rectangle", "name": "floor", "size_x_m": 4.0, "size_y_m": 4.0, "color": "#ffffff"}
ROBOT = {"name": "thymio", "x_m": 0.0, "y_m": 0.0}


def make(shapes: Sequence[Mapping[str, Any]] = (FLOOR,), robots: Sequence[Mapping[str, Any]] = (ROBOT,)) -> Playground:
    """A playground of shapes and robots."""
    data = {"format": 1, "title": "test", "shapes": list(shapes), "robots": list(robots)}
    return playground.loads(json.dumps(data), "test")


def shipped(name: str) -> Playground:
    """A playground of the repository."""
    return playground.load(PLAYGROUNDS / f"{name}.json")


def run(world: World, seconds: float) -> list[StepResult]:
    """Every step of so many simulated seconds."""
    return [world.step() for _ in range(round(seconds * 1e9 / TICK_NS))]


def readings(steps: Sequence[StepResult], sensor: str) -> list[Any]:
    """The readings of one sensor of the first robot, in order."""
    found: list[Reading] = []
    for step in steps:
        names = [robot for robot, _, _ in step.readings]
        found += [reading for robot, name, reading in step.readings if name == sensor and robot == names[0]]
    return found


def box(
    x_m: float, y_m: float, size_x_m: float, size_y_m: float, *, yaw_rad: float = 0.0, height_m: float = 0.1
) -> dict[str, Any]:
    """A grey box."""
    return {
        "kind": "box", "x_m": x_m, "y_m": y_m, "yaw_rad": yaw_rad,
        "size_x_m": size_x_m, "size_y_m": size_y_m, "height_m": height_m, "color": GREY,
    }  # fmt: skip


def post_wall(distance_m: float) -> dict[str, Any]:
    """A wide wall across the x axis whose near face is `distance_m` before the middle front sensor."""
    return box(0.0795 + distance_m + 0.01, 0.0, 0.02, 1.0)


def sense(world: World, sensor: str, robot: str | None = None) -> Any:
    """The next reading of a sensor of a robot (the first one unless named)."""
    robot = robot or next(iter(world.robots))
    while True:
        for name, found, reading in world.step().readings:
            if name == robot and found == sensor:
                return reading


def send(world: World, command: Command) -> None:
    """Post to the first robot."""
    world.post(next(iter(world.robots)), command)


def enki(family: str) -> dict[str, list[dict[str, Any]]]:
    """Families of measured scenes (tests/data/enki)."""
    data: dict[str, list[dict[str, Any]]] = json.loads((ENKI / f"{family}.json").read_text())
    return data


def enki_world(entry: Mapping[str, Any], **options: Any) -> World:
    """The world of a measured scene; robots are in their places even where a start would be refused."""
    shapes: list[dict[str, Any]] = []
    if entry["world"]["kind"] == "square":
        width, height = entry["world"]["width"], entry["world"]["height"]
        place = {"x_m": width / 2, "y_m": height / 2, "size_x_m": width + 0.02, "size_y_m": height + 0.02}
        shapes.append({"kind": "rectangle", **place, "color": GREY, "walls": {"height_m": 1.0}})
    shapes += [enki_thing(thing, f"thing{index}") for index, thing in enumerate(entry["objects"])]
    built = make(shapes, [])
    starts = [
        RobotStart(f"robot{index}", start["x"], start["y"], start["theta"])
        for index, start in enumerate(entry["robots"])
    ]
    solids = [
        replace(solid, load=replace(solid.load, lever_m=enki_lever(solid))) if solid.load is not None else solid
        for solid in built.solids
    ]
    return World(replace(built, robots=tuple(starts), solids=tuple(solids)), **options)


def enki_thing(thing: Mapping[str, Any], name: str) -> dict[str, Any]:
    """A thing of a measured scene. The reference takes g as 9.81 cm/s² and multiplies elasticities, 0.9 the robot's."""
    shape = {"kind": thing["kind"], "name": name, "x_m": thing["x"], "y_m": thing["y"], "color": GREY}
    shape["height_m"] = thing["height"]
    if thing["kind"] == "box":
        shape |= {"yaw_rad": thing["theta"], "size_x_m": thing["size_x"], "size_y_m": thing["size_y"]}
    else:
        shape["radius_m"] = thing["radius"]
    if thing.get("mass") is not None:
        shape["mass_kg"] = thing["mass"] * thymio2.MASS_KG / 200
        shape["friction"] = thing.get("dry_friction", 0.25) / 100
        shape["restitution"] = thing.get("elasticity", 0.9) * 0.9
    return shape


def enki_lever(solid: Solid) -> float:
    """The lever with which turning slows by the friction times 9.81 rad/s², as it does in the reference."""
    outline = solid.outline
    assert not isinstance(outline, Polygon)
    if isinstance(outline, Disc):
        return outline.radius_m**2 / 2 * 100
    return (outline.size_x_m**2 + outline.size_y_m**2) / 12 * 100


def pose_close(one: Pose, other: Pose, tolerance: float = 1e-9) -> bool:
    """Whether two poses differ by less than a tolerance in each part."""
    return all(
        abs(a - b) < tolerance for a, b in ((one.x_m, other.x_m), (one.y_m, other.y_m), (one.yaw_rad, other.yaw_rad))
    )
