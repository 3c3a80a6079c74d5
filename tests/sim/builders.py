"""Small worlds for tests: playgrounds from plain data, runs of a number of seconds."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from thymio_sim_ros.sim.commands import Command
from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.readings import Reading
from thymio_sim_ros.sim.playground import reader
from thymio_sim_ros.sim.playground.reader import Playground
from thymio_sim_ros.sim.world import StepResult, World

REPOSITORY = Path(__file__).parents[2]
PLAYGROUNDS = REPOSITORY / "playgrounds"

GRAY = "#808080"
FLOOR = {"kind": "rectangle", "name": "floor", "size_x_m": 4.0, "size_y_m": 4.0, "color": "#ffffff"}
ROBOT = {"name": "thymio", "x_m": 0.0, "y_m": 0.0}


def make(shapes: Sequence[Mapping[str, Any]] = (FLOOR,), robots: Sequence[Mapping[str, Any]] = (ROBOT,)) -> Playground:
    """A playground of shapes and robots."""
    data = {"format": 1, "title": "test", "shapes": list(shapes), "robots": list(robots)}
    return reader.loads(json.dumps(data), "test")


def shipped(name: str) -> Playground:
    """A playground of the repository."""
    return reader.load(PLAYGROUNDS / f"{name}.json")


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
    """A gray box."""
    return {
        "kind": "box", "x_m": x_m, "y_m": y_m, "yaw_rad": yaw_rad,
        "size_x_m": size_x_m, "size_y_m": size_y_m, "height_m": height_m, "color": GRAY,
    }  # fmt: skip


def post_wall(distance_m: float) -> dict[str, Any]:
    """A wide wall across the x axis whose near face is `distance_m` before the middle front sensor."""
    return box(0.0795 + distance_m + 0.01, 0.0, 0.02, 1.0)


def measure_one(world: World, sensor: str, robot: str | None = None) -> Any:
    """The next reading of a sensor of a robot (the first one unless named)."""
    robot = robot or next(iter(world.robots))
    while True:
        for name, found, reading in world.step().readings:
            if name == robot and found == sensor:
                return reading


def send(world: World, command: Command) -> None:
    """Post to the first robot."""
    world.post(next(iter(world.robots)), command)


def pose_close(one: Pose, other: Pose, tolerance: float = 1e-9) -> bool:
    """Whether two poses differ by less than a tolerance in each part."""
    return all(
        abs(a - b) < tolerance for a, b in ((one.x_m, other.x_m), (one.y_m, other.y_m), (one.yaw_rad, other.yaw_rad))
    )
