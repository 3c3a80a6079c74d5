"""Some robots move analytically, others in the space; the rules are the same for single robots and for batches."""

from __future__ import annotations

import math

import numpy as np
import pytest

from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Box, Load, Slide, Solid, Trigger
from thymio_sim_ros.sim.physics import Physics, RobotBody

GRAY = (0.5, 0.5, 0.5)
WALL = Solid("wall", Pose(0.3, 0.0, 0.0), Box(0.02, 1.0), 0.1, GRAY)
FAST_M_S = 0.16
together = pytest.mark.parametrize("is_fleet", [False, True])


class Driver:
    """Robots that keep their speeds, and what becomes of them."""

    def __init__(self, is_fleet: bool, solids: list[Solid], triggers: list[Trigger], *poses: Pose) -> None:
        self.physics = Physics(solids, triggers)
        self.robots = [self.physics.add_robot(f"robot_{index}", pose) for index, pose in enumerate(poses)]
        self.batch_driver = self.physics.form_batch() if is_fleet else None
        self.speeds = [(0.0, 0.0)] * len(poses)

    def step(self) -> None:
        for robot, speeds in zip(self.robots, self.speeds, strict=True):
            robot.drive(speeds)
        if self.batch_driver is not None:
            self.batch_driver.driven = np.array(self.speeds).T
        self.physics.step()

    def engaged(self) -> list[bool]:
        return [robot.is_active for robot in self.robots]


def straight(robot: RobotBody) -> float:
    return robot.pose.x_m


@together
def test_one_robot_at_a_wall_leaves_another_in_the_open_to_glide(is_fleet: bool) -> None:
    driver = Driver(is_fleet, [WALL], [], Pose(0.206, 0.0, 0.0), Pose(-1.0, 0.3, 0.0))
    driver.speeds = [(FAST_M_S, FAST_M_S)] * 2
    for _ in range(200):
        driver.step()
        assert driver.engaged() == [True, False]
    assert list(driver.robots[0].touching) != []
    assert straight(driver.robots[0]) == pytest.approx(0.21, abs=0.001)
    assert straight(driver.robots[1]) == pytest.approx(-1.0 + 2.0 * FAST_M_S, abs=1e-9)


@together
def test_a_robot_that_leaves_a_wall_glides_again_and_comes_back_to_it(is_fleet: bool) -> None:
    driver = Driver(is_fleet, [WALL], [], Pose(0.19, 0.0, 0.0))
    seen = []
    for speed in (FAST_M_S, -FAST_M_S, FAST_M_S):
        driver.speeds = [(speed, speed)]
        for _ in range(300):
            driver.step()
        seen.append((driver.engaged()[0], len(driver.robots[0].touching)))
    assert seen == [(True, 1), (False, 0), (True, 1)]
    assert straight(driver.robots[0]) == pytest.approx(0.21, abs=0.001)


@together
def test_a_robot_put_before_another_is_met(is_fleet: bool) -> None:
    driver = Driver(is_fleet, [], [], Pose(0.0, 0.0, 0.0), Pose(5.0, 0.0, 0.0))
    driver.speeds = [(FAST_M_S, FAST_M_S), (0.0, 0.0)]
    driver.step()
    assert driver.engaged() == [False, False]
    driver.physics.place(driver.robots[1], Pose(0.17, 0.0, math.pi))
    for _ in range(50):
        driver.step()
    assert [len(robot.touching) for robot in driver.robots] == [1, 1]


@together
def test_an_object_put_before_a_gliding_robot_is_pushed(is_fleet: bool) -> None:
    crate = Solid("crate", Pose(3.0, 0.0, 0.0), Box(0.06, 0.06), 0.1, GRAY, Load(0.05, 0.3, 0.02))
    driver = Driver(is_fleet, [crate], [], Pose(0.0, 0.0, 0.0))
    driver.speeds = [(FAST_M_S, FAST_M_S)]
    driver.step()
    assert driver.engaged() == [False]
    driver.physics.place(driver.physics.movables["crate"], Pose(0.13, 0.0, 0.0))
    for _ in range(100):
        driver.step()
    assert driver.physics.movables["crate"].pose.x_m == pytest.approx(straight(driver.robots[0]) + 0.11, abs=0.002)


@together
def test_while_a_door_moves_all_robots_are_active(is_fleet: bool) -> None:
    closed, opened = Pose(2.0, 0.0, 0.0), Pose(2.0, 0.5, 0.0)
    door = Solid("door", closed, Box(0.02, 0.4), 0.1, GRAY, slide=Slide(opened, 0.5))
    area = Trigger("area", ((-0.1, -0.1), (0.1, -0.1), (0.1, 0.1), (-0.1, 0.1)), "door")
    driver = Driver(is_fleet, [door], [area], Pose(0.0, 0.0, 0.0), Pose(0.0, 1.0, 0.0))
    seen = []
    for _ in range(80):
        driver.step()
        seen.append((driver.physics.doors["door"].is_moving, driver.engaged()))
    assert seen[:50] == [(True, [True, True])] * 50
    assert seen[-1] == (False, [False, False])


@together
def test_a_fast_object_does_not_pass_through_a_robot_that_was_gliding(is_fleet: bool) -> None:
    ball = Solid("ball", Pose(-1.0, 0.0, 0.0), Box(0.04, 0.04), 0.1, GRAY, Load(0.05, 0.01, 0.02))
    driver = Driver(is_fleet, [ball], [], Pose(0.0, 0.0, 0.0))
    driver.step()
    assert driver.engaged() == [False]
    thing = driver.physics.movables["ball"]
    driver.physics.place(thing, Pose(-0.8, 0.0, 0.0))
    thing.body.velocity = (3.0, 0.0)
    thing.is_moving = thing.is_fast = True
    met = False
    for _ in range(100):
        driver.step()
        met |= len(driver.robots[0].touching) > 0
    assert met
    assert thing.pose.x_m < straight(driver.robots[0])
