"""The file of obstacles by place: never one too few, and few when much is far away."""

from __future__ import annotations

import math
import random

from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.raycast.broadphase import Broadphase
from thymio_sim_ros.sim.raycast.scalar import DiscObstacle, Obstacle


class Ball:
    """A mover for tests."""

    def __init__(self, x_m: float, y_m: float, reach_m: float = 0.1) -> None:
        self.pose, self.reach_m = Pose(x_m, y_m, 0.0), reach_m

    @property
    def obstacle(self) -> Obstacle:
        return DiscObstacle(self.pose.x_m, self.pose.y_m, self.reach_m, 0.1)


def discs(dice: random.Random, count: int) -> list[DiscObstacle]:
    return [DiscObstacle(dice.uniform(-5, 5), dice.uniform(-5, 5), dice.uniform(0.01, 1.0), 0.1) for _ in range(count)]


def test_no_fixed_obstacle_within_reach_is_missed() -> None:
    dice = random.Random(1)
    obstacles = discs(dice, 200)
    broadphase = Broadphase(obstacles)
    for _ in range(300):
        x, y, reach = dice.uniform(-6, 6), dice.uniform(-6, 6), dice.choice((0.05, 0.3, 2.0, 50.0))
        found = broadphase.fixed(x, y, reach)
        assert len(found) == len(set(found))
        assert {obstacle for obstacle in obstacles if obstacle.is_within(x, y, reach)} <= set(found)


def test_no_mover_within_reach_is_missed_after_it_moved() -> None:
    dice = random.Random(2)
    balls = [Ball(dice.uniform(-5, 5), dice.uniform(-5, 5), dice.uniform(0.05, 0.3)) for _ in range(100)]
    broadphase = Broadphase(())
    broadphase.replace_movers(balls)
    for _ in range(20):
        for ball in balls:
            ball.pose = Pose(ball.pose.x_m + dice.uniform(-1, 1), ball.pose.y_m + dice.uniform(-1, 1), 0.0)
        broadphase.invalidate_movers()
        x, y, reach = dice.uniform(-5, 5), dice.uniform(-5, 5), dice.uniform(0.1, 1.0)
        expected = {ball for ball in balls if math.hypot(ball.pose.x_m - x, ball.pose.y_m - y) <= reach + ball.reach_m}
        assert set(broadphase.movers(x, y, reach)) == expected


def test_what_is_far_away_is_not_looked_at() -> None:
    obstacles = [DiscObstacle(float(index), 0.0, 0.1, 0.1) for index in range(100)]
    broadphase = Broadphase(obstacles)
    assert set(broadphase.fixed(50.0, 0.0, 0.2)) <= set(obstacles[49:52])


def test_a_huge_obstacle_is_found_everywhere() -> None:
    huge = DiscObstacle(0.0, 0.0, 50.0, 0.1)
    assert Broadphase([huge]).fixed(40.0, 10.0, 0.2) == (huge,)
