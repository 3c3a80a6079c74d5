"""Robots that move as one; robots that move alone are the oracle."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest

from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Box, Load, Solid
from thymio_sim_ros.sim.physics import Physics, RobotBody

GRAY = (0.5, 0.5, 0.5)
WALL = Solid("wall", Pose(0.4, 0.0, 0.0), Box(0.02, 2.0), 0.1, GRAY)
CRATE = Solid("crate", Pose(-0.2, 0.02, 0.3), Box(0.06, 0.06), 0.1, GRAY, Load(0.05, 0.3, 0.02))
STARTS = [Pose(0.0, 0.0, 0.1), Pose(0.0, 0.25, 3.0), Pose(0.25, 0.3, -1.5), Pose(-0.4, 0.0, 0.0)]


def physics(*solids: Solid) -> tuple[Physics, list[RobotBody]]:
    found = Physics(solids)
    return found, [found.add_robot(f"robot_{index}", pose) for index, pose in enumerate(STARTS)]


def speeds(dice: random.Random) -> list[tuple[float, float]]:
    return [(dice.uniform(0.0, 0.16), dice.uniform(0.0, 0.16)) for _ in STARTS]


def numbers(robots: list[RobotBody]) -> list[float]:
    return [
        number
        for robot in robots
        for number in (robot.pose.x_m, robot.pose.y_m, robot.pose.yaw_rad, robot.speed_m_s, robot.spin_rad_s)
    ]


@pytest.mark.parametrize("solids", [(), (WALL,), (WALL, CRATE)])
@pytest.mark.parametrize("seed", range(3))
def test_a_fleet_moves_as_its_robots_would_alone(solids: tuple[Solid, ...], seed: int) -> None:
    (one, alone), (other, together) = physics(*solids), physics(*solids)
    batch_driver = other.form_batch()
    dice = random.Random(seed)
    close = 1e-3  # in a jam the last bit decides which corners touch
    for tick in range(300):
        if tick % 50 == 0:
            wheels = speeds(dice)
        for robot, pair in zip(alone, wheels, strict=True):
            robot.drive(pair)
        batch_driver.driven = np.array(wheels).T
        contacts = one.step()
        assert [(contact.robot, contact.other) for contact in other.step()] == [
            (contact.robot, contact.other) for contact in contacts
        ]
        assert numbers(together) == pytest.approx(numbers(alone), abs=close)
        covered = [speed for robot in alone for speed in robot.covered_m_s]
        assert batch_driver.covered.T.ravel() == pytest.approx(covered, abs=close)
        for name, movable in one.movables.items():
            pose = other.movables[name].pose
            assert math.dist((pose.x_m, pose.y_m), (movable.pose.x_m, movable.pose.y_m)) < close


def test_a_robot_may_be_placed_dropped_and_placed_again() -> None:
    (one, alone), (other, together) = physics(WALL), physics(WALL)
    batch_driver = other.form_batch()
    wheels = [(0.1, 0.08)] * len(STARTS)
    for tick in range(200):
        for found, robots in ((one, alone), (other, together)):
            if tick == 50:
                found.place(robots[1], Pose(-0.5, 0.5, 1.0))
            if tick == 80:
                found.drop_robot(robots[2])
            if tick == 120:
                found.place(robots[2], Pose(-0.5, -0.5, 0.0))
        for robot, pair in zip(alone, wheels, strict=True):
            robot.drive(pair)
        batch_driver.driven = np.array(wheels).T
        one.step()
        other.step()
        assert batch_driver.fallen.tolist() == ([2] if 80 <= tick < 120 else [])
        assert numbers(together) == pytest.approx(numbers(alone), abs=1e-9)


def test_disbanded_the_robots_go_on_as_if_they_had_driven_alone() -> None:
    (one, alone), (other, together) = physics(WALL), physics(WALL)
    for tick in range(200):
        if tick in (20, 120):
            batch_driver = other.form_batch()
        if tick in (80, 160):
            other.dissolve()
        for robot in (*alone, *together):
            robot.drive((0.12, 0.1))
        if together[0].batch_driver is not None:
            batch_driver.driven = np.array([(0.12, 0.1)] * len(STARTS)).T
        one.step()
        other.step()
        assert numbers(together) == pytest.approx(numbers(alone), abs=1e-9)


def test_a_robot_more_or_less_disbands_a_fleet() -> None:
    found, robots = physics()
    found.form_batch()
    added = found.add_robot("more", Pose(1.0, 1.0, 0.0))
    assert robots[0].batch_driver is None
    found.form_batch()
    found.remove_robot(added)
    assert robots[0].batch_driver is None
