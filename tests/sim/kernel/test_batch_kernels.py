"""The kernels by which crowds drive give the bits of numpy, compiled and run by Python."""

from __future__ import annotations

import random
from collections.abc import Iterator

import numpy as np
import pytest
from thymio_sim_ros.sim.physics.broadphase_batch import BroadphaseBatch

from tests.sim.batch.test_robot_batch import busy
from tests.sim.builders import shipped
from thymio_sim_ros.sim.commands import MotorTargets, MoveRobot
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Box, Solid
from thymio_sim_ros.sim.playground.reader import Playground
from thymio_sim_ros.sim.raycast.scalar import obstacle_of
from thymio_sim_ros.sim.world import World

WHERE = ("physics.batch_driver", "physics.broadphase_batch", "mechanics.wheels")


def steps(monkeypatch: pytest.MonkeyPatch, scene: Playground, elsewhere: Pose, *, is_compiled: bool) -> Iterator[bytes]:
    """The state, tick by tick, of a batch whose robots drive, push, fall, are moved and read."""
    for module in WHERE:
        monkeypatch.setattr(f"thymio_sim_ros.sim.{module}.is_available", lambda: is_compiled)
    world = World(scene)
    dice = random.Random(2)
    names = tuple(world.robots)
    for tick in range(240):
        for name in names:
            if tick == 0 or dice.random() < 0.01:
                world.post(name, MotorTargets(dice.randint(100, 500), dice.randint(100, 500)))
        if tick == 90:
            here = world.robots[names[0]].pose
            world.post(names[0], MoveRobot(here.x_m, here.y_m, here.yaw_rad))
            world.post(names[1], MoveRobot(elsewhere.x_m, elsewhere.y_m, elsewhere.yaw_rad))
        result = world.step()
        batch = world._batch
        assert batch is not None
        reported = repr([(contact.robot, contact.other, contact.is_new) for contact in result.contacts])
        values = [
            batch.batch_driver.poses,
            *batch.batch_driver.motion,
            batch.batch_driver.covered,
            batch.wheels.odometry,
        ]
        values += [batch.wheels.speeds, batch.wheels.angles]
        yield reported.encode() + b"".join(np.ascontiguousarray(part + 0.0).tobytes() for part in values)
        if tick % 50 == 7:
            yield repr([(robot.pose, robot.wheels.odometry) for robot in world.robots.values()]).encode()


@pytest.mark.usefixtures("kernels")
@pytest.mark.parametrize("scene", ["busy", "classroom"])
def test_a_batch_drives_bit_for_bit(scene: str, monkeypatch: pytest.MonkeyPatch) -> None:
    playground, elsewhere = (
        (busy(random.Random(4), 18), Pose(0.02, 0.95, 1.0))
        if scene == "busy"
        else (shipped(scene), Pose(0.0, 1.4, 2.0))
    )
    by_numpy = list(steps(monkeypatch, playground, elsewhere, is_compiled=False))
    by_kernels = list(steps(monkeypatch, playground, elsewhere, is_compiled=True))
    assert len(set(by_numpy)) > 200
    assert sum(not reported.startswith(b"[]") for reported in by_numpy) > 50
    first = next((tick for tick, pair in enumerate(zip(by_numpy, by_kernels, strict=True)) if pair[0] != pair[1]), None)
    assert first is None


@pytest.mark.usefixtures("kernels")
@pytest.mark.parametrize("seed", range(6))
def test_the_same_robots_are_near_something(seed: int) -> None:
    dice = random.Random(seed)

    def place() -> tuple[float, float, float]:
        return (dice.uniform(-1.5, 1.5), dice.uniform(-1.5, 1.5), dice.uniform(-3.0, 3.0))

    fixed = [
        obstacle_of(Solid(f"{n}", Pose(*place()), Box(dice.uniform(0.01, 0.6), 0.05), 0.1, (0, 0, 0)))
        for n in range(dice.randint(0, 6))
    ]
    both = [BroadphaseBatch(fixed, is_compiled=is_compiled) for is_compiled in (False, True)]
    things = dice.randint(0, 5)
    seen = set[bool]()
    for _ in range(10):
        poses = np.array([place() for _ in range(25)]).T
        stands = np.array([dice.random() < 0.9 for _ in range(25)])
        loose = np.array([(*place()[:2], 0.05) for _ in range(things)]).reshape(-1, 3).T
        one, other = (broadphase.near(poses, stands, loose).tolist() for broadphase in both)
        assert one == other
        seen.update(one)
    assert seen == {True, False}
