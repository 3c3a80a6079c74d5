"""Rays of all robots at once; the rays of `Surroundings`, one by one, are the oracle."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence

import numpy as np
import pytest

from thymio_sim_ros.sim.kernel.memory import KernelMemory
from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.robot_state import RobotState
from thymio_sim_ros.sim.raycast.raycaster import Fan, Raycaster
from thymio_sim_ros.sim.raycast.scalar import ConvexObstacle, DiscObstacle, Obstacle, Surroundings

ANGLES = (-0.3, -0.1, 0.0, 0.25)
FAN = Fan(
    [(0.05, 0.03), (-0.02, 0.0)],
    [[(math.cos(yaw + angle), math.sin(yaw + angle)) for angle in ANGLES] for yaw in (0.4, math.pi)],
    range_m=0.2,
    height_m=0.03,
)


def box(pose: Pose, half_x: float, half_y: float, height_m: float = 0.1) -> ConvexObstacle:
    corners = ((-half_x, -half_y), (half_x, -half_y), (half_x, half_y), (-half_x, half_y))
    return ConvexObstacle(pose.place_all(corners), height_m)


def one_by_one(poses: Sequence[Pose], obstacles: Sequence[Obstacle], fan: Fan) -> list[list[float]]:
    """Distances of every ray of every sensor of every robot."""
    hulls = [ConvexObstacle(pose.place_all(robot_constants.hull()), robot_constants.HULL_HEIGHT_M) for pose in poses]
    found = []
    for index, pose in enumerate(poses):
        high = [obstacle for obstacle in obstacles if obstacle.height_m >= fan.height_m]
        around = Surroundings([*high, *hulls[:index], *hulls[index + 1 :]])
        turn = Pose(0.0, 0.0, pose.yaw_rad)
        for sensor, place in enumerate(fan.places.T.tolist()):
            rays = [turn.place(tuple(ray)) for ray in fan.directions[:, sensor].T.tolist()]
            found.append(list(around.fan(*pose.place(tuple(place)), rays, fan.range_m)))
    return found


class Caster:
    """Robots and a ray caster in a memory of their own."""

    def __init__(
        self, robots: int, fixed: Sequence[Obstacle], loose: Sequence[Obstacle | None] = (), fan: Fan = FAN
    ) -> None:
        memory = KernelMemory(1 << 22)
        self.robots = RobotState(memory, robots)
        self.robots.is_standing[:] = 1
        raycaster = Raycaster(memory, self.robots, robots, fixed, loose)
        self.raycaster, self.move = raycaster, raycaster.move
        self._cast, self._distances = raycaster.bind(fan)

    def cast(self, poses: Sequence[Pose]) -> list[list[float]]:
        """Distances of every ray of every sensor of every robot."""
        places = np.array([(pose.x_m, pose.y_m, pose.yaw_rad) for pose in poses]).reshape(-1, 3).T
        self.robots.x[:], self.robots.y[:], self.robots.yaw[:] = places
        self._cast()
        rows: list[list[float]] = self._distances.reshape(-1, self._distances.shape[2]).tolist()
        return rows


def close(one: list[list[float]], other: list[list[float]]) -> bool:
    return all(a == pytest.approx(b, abs=1e-9, rel=0) for a, b in zip(one, other, strict=True))


def scatter(dice: random.Random, count: int, side: float) -> list[Pose]:
    return [Pose(dice.uniform(0, side), dice.uniform(0, side), dice.uniform(-4, 4)) for _ in range(count)]


def things(dice: random.Random, count: int, side: float) -> list[Obstacle]:
    """Boxes, thin walls, discs, triangles and hexagons, some too low to be seen."""
    found: list[Obstacle] = []
    for pose in scatter(dice, count, side):
        height = dice.choice((0.02, 0.05, 0.1))
        match dice.randrange(4):
            case 0:
                found.append(box(pose, dice.uniform(0.01, 0.1), dice.uniform(0.01, 0.1), height))
            case 1:
                found.append(box(pose, dice.uniform(0.2, side), 0.005, height))
            case 2:
                found.append(DiscObstacle(pose.x_m, pose.y_m, dice.uniform(0.005, 0.1), height))
            case _:
                sides, radius = dice.choice((3, 6)), dice.uniform(0.02, 0.1)
                turns = [math.tau * side / sides for side in range(sides)]
                corners = pose.place_all([(radius * math.cos(turn), radius * math.sin(turn)) for turn in turns])
                found.append(ConvexObstacle(corners, height))
    return found


@pytest.mark.parametrize("seed", range(25))
def test_random_scenes_agree_with_rays_one_by_one(seed: int) -> None:
    dice = random.Random(seed)
    obstacles, poses = things(dice, 12, 1.5), scatter(dice, dice.choice((1, 2, 15)), 1.5)
    assert close(Caster(len(poses), obstacles).cast(poses), one_by_one(poses, obstacles, FAN))


def test_rays_along_the_sides_of_a_box_agree() -> None:
    fan = Fan([(0.0, 0.0)], [[(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]], 0.5, 0.0)
    obstacles = [
        box(Pose(0.3, 0.0, 0.0), 0.1, 0.1),
        box(Pose(0.0, 0.3, 0.0), 0.2, 0.1),
        box(Pose(-0.3, 0.2, 0.0), 0.1, 0.1),
    ]
    found = Caster(1, obstacles, fan=fan).cast([Pose(0.0, 0.0, 0.0)])
    assert found == [pytest.approx([0.2, 0.2, math.inf, math.inf])]


def test_while_robots_wander_what_is_near_stays_up_to_date() -> None:
    dice = random.Random(3)
    obstacles, poses = things(dice, 20, 2.0), scatter(dice, 10, 2.0)
    caster = Caster(len(poses), obstacles)
    for _ in range(60):
        poses = [
            Pose(p.x_m + dice.uniform(-0.02, 0.03), p.y_m + dice.uniform(-0.02, 0.03), p.yaw_rad + dice.uniform(-1, 1))
            for p in poses
        ]
        assert close(caster.cast(poses), one_by_one(poses, obstacles, FAN))


def test_objects_that_move_are_seen_where_they_are() -> None:
    dice = random.Random(4)
    fixed, loose, poses = things(dice, 5, 1.0), things(dice, 5, 1.0), scatter(dice, 6, 1.0)
    caster = Caster(len(poses), fixed, loose)
    for step in range(5):
        loose = things(dice, 5, 1.0) if step % 2 else loose
        caster.move(dict(enumerate(loose)))
        assert close(caster.cast(poses), one_by_one(poses, [*fixed, *loose], FAN))


def test_what_is_gone_or_fallen_is_not_seen_and_sees_nothing() -> None:
    dice = random.Random(6)
    loose, poses = things(dice, 8, 1.0), scatter(dice, 6, 1.0)
    caster = Caster(len(poses), [], loose)
    caster.move({0: None})
    caster.robots.is_standing[2] = 0
    left = [pose for index, pose in enumerate(poses) if index != 2]
    found = caster.cast(poses)
    assert found[4:6] == [[math.inf] * 4] * 2
    assert close(found[:4] + found[6:], one_by_one(left, loose[1:], FAN))
    caster.move(dict(enumerate(loose)))
    caster.robots.is_standing[2:4] = 1, 0
    left = [pose for index, pose in enumerate(poses) if index != 3]
    found = caster.cast(poses)
    assert found[6:8] == [[math.inf] * 4] * 2
    assert close(found[:6] + found[8:], one_by_one(left, loose, FAN))
    caster.robots.is_standing[3] = 1
    assert close(caster.cast(poses), one_by_one(poses, loose, FAN))


def test_two_fans_in_use_each_keep_what_is_near_them_up_to_date() -> None:
    dice = random.Random(8)
    far = Fan([(0.02, 0.0)], [[(math.cos(turn), math.sin(turn)) for turn in range(4)]], range_m=1.0, height_m=0.05)
    fixed, poses = things(dice, 6, 1.5), scatter(dice, 5, 1.5)
    discs = [DiscObstacle(pose.x_m, pose.y_m, 0.04, 0.1) for pose in scatter(dice, 6, 1.5)]
    caster = Caster(len(poses), fixed, discs)
    cast_far, lengths = caster.raycaster.bind(far)
    for step in range(40):
        poses = [Pose(p.x_m + dice.uniform(-0.02, 0.03), p.y_m, p.yaw_rad + dice.uniform(-1, 1)) for p in poses]
        discs = [DiscObstacle(disc.x_m + dice.uniform(-0.04, 0.04), disc.y_m, 0.04, 0.1) for disc in discs]
        loose = [None if step % 7 == number else disc for number, disc in enumerate(discs)]
        caster.move(dict(enumerate(loose)))
        there = [*fixed, *(one for one in loose if one is not None)]
        assert close(caster.cast(poses), one_by_one(poses, there, FAN))
        cast_far()
        rows: list[list[float]] = lengths.reshape(-1, 4).tolist()
        assert close(rows, one_by_one(poses, there, far))


def test_without_robots_or_objects_nothing_is_seen() -> None:
    assert Caster(0, []).cast([]) == []
    assert Caster(1, []).cast([Pose(0.0, 0.0, 0.0)]) == [[math.inf] * 4] * 2
