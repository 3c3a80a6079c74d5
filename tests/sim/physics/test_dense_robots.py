"""Crowds of robots and things that push each other at random: nothing overlaps, nothing jumps, nothing is lost."""

from __future__ import annotations

import math
import random
from typing import Any

import pytest

from tests.sim.builders import FLOOR, GRAY, box, make
from thymio_sim_ros.sim.commands import MotorTargets
from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Box, Disc, Solid
from thymio_sim_ros.sim.playground.placement import Footprint, Occupied, footprint_of, footprint_of_robot
from thymio_sim_ros.sim.world import World

OVERLAP_M = 0.002
JUMP_M = 0.01


def crowded(dice: random.Random, robots: int) -> World:
    """A walled square of 1.2 m, full of robots, posts and things of 10 g to 5 kg."""
    shapes: list[dict[str, Any]] = [{**FLOOR, "size_x_m": 1.2, "size_y_m": 1.2, "walls": {}}]
    starts: list[dict[str, Any]] = []
    occupied = Occupied()
    for index in range(40):
        x, y, yaw = dice.uniform(-0.5, 0.5), dice.uniform(-0.5, 0.5), dice.uniform(-3, 3)
        place = {"name": f"thing{index}", "x_m": x, "y_m": y}
        shape: dict[str, Any] = {"kind": "cylinder", "radius_m": dice.uniform(0.01, 0.05), "height_m": 0.1}
        if index < robots:
            footprint = footprint_of_robot(f"thing{index}", Pose(x, y, yaw))
        else:
            if dice.random() < 0.5:
                shape = box(x, y, dice.uniform(0.02, 0.1), dice.uniform(0.02, 0.1), yaw_rad=yaw)
            if dice.random() < 0.8:
                shape["mass_kg"] = 10 ** dice.uniform(-2, 0.7)
            shape = {**shape, "color": GRAY, **place}
            footprint = footprint_of(make([shape], []).solids[0])
        if occupied.blocker(footprint) is not None:
            continue
        occupied.add(footprint)
        if index < robots:
            starts.append({**place, "yaw_rad": yaw})
        else:
            shapes.append(shape)
    return World(make(shapes, starts), seed=dice.randint(0, 99))


def cores(world: World) -> list[Footprint]:
    """What everything surely covers: its footprint without a rim."""
    solids = {solid.name: solid for solid in world.playground.solids if solid.name.startswith("thing")}
    placed = [solids[thing.name].at(thing.pose) for thing in world.objects]
    fixed = [solid for solid in solids.values() if solid.is_fixed]
    return [*map(core, (*placed, *fixed)), *(core_of_robot(name, robot.pose) for name, robot in world.robots.items())]


def core(solid: Solid) -> Footprint:
    outline = solid.outline
    if isinstance(outline, Disc):
        outline = Disc(outline.radius_m - OVERLAP_M / 2)
    else:
        assert isinstance(outline, Box)
        outline = Box(outline.size_x_m - OVERLAP_M, outline.size_y_m - OVERLAP_M)
    return footprint_of(Solid(solid.name, solid.pose, outline, solid.height_m, solid.color))


def core_of_robot(name: str, pose: Pose) -> Footprint:
    middle = 0.025
    hull = [((x - middle) * 0.96 + middle, y * 0.96) for x, y in robot_constants.hull()]
    return Footprint(name, (pose.x_m, pose.y_m), robot_constants.HULL_RADIUS_M, pose.place_all(hull))


@pytest.mark.parametrize("robots", [1, 4, 12])
@pytest.mark.parametrize("seed", range(3))
def test_nothing_overlaps_and_nothing_jumps(seed: int, robots: int) -> None:
    dice = random.Random(100 * robots + seed)
    world = crowded(dice, robots)
    before: dict[str, Pose] = {}
    for tick in range(1200):
        if tick % 100 == 0:
            for robot in world.robots:
                world.post(robot, MotorTargets(dice.randint(-500, 500), dice.randint(-500, 500)))
        world.step()
        snapshot = world.snapshot()
        now = {body.name: body.pose for body in (*snapshot.robots, *snapshot.objects)}
        for name, pose in now.items():
            last = before.get(name, pose)
            assert math.dist((pose.x_m, pose.y_m), (last.x_m, last.y_m)) < JUMP_M, (tick, name)
            assert max(abs(pose.x_m), abs(pose.y_m)) < 0.6, (tick, name)
        before = now
        if tick % 50 == 0:
            occupied = Occupied()
            for footprint in cores(world):
                assert occupied.blocker(footprint) is None, (tick, footprint.name)
                occupied.add(footprint)
