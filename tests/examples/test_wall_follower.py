"""The wall follower: around a square, at its distance, and through a maze."""

from __future__ import annotations

import math

import pytest

from tests.seeds import seeds
from thymio_sim_ros.testing import no_contact, reached

NODE = "thymio_sim_ros.examples.wall_follower"
WALL_M = 0.5
"""From the middle of the playground `base` to its four walls."""


def to_the_wall(pose):
    """Distance in m from the middle of the robot's axle to the nearest wall of `base`."""
    return WALL_M - max(abs(pose.x_m), abs(pose.y_m))


@pytest.mark.parametrize("seed", seeds(2))
def test_it_drives_around_with_the_walls_on_its_right_and_touches_nothing(ros, simulation, seed):
    sim = simulation(playground="base", seed=seed)
    ros.start(NODE)
    sim.until(lambda: to_the_wall(sim.thymio.pose) < 0.15, seconds=10)
    begin, heading = sim.now, sim.thymio.pose.yaw_rad
    for corner in [(0.35, 0.35), (-0.35, 0.35), (-0.35, -0.35), (0.35, -0.35)]:
        sim.until(reached(sim.thymio, corner, tolerance=0.1), seconds=15)
    assert no_contact(sim.thymio)
    assert max(to_the_wall(moment.pose) for moment in sim.thymio.path if moment.at_s > begin) < 0.17
    assert sim.thymio.pose.yaw_rad - heading == pytest.approx(2.0 * math.pi, abs=0.5), "it turned to the left"


@pytest.mark.parametrize(("distance", "middle_m"), [(0.05, 0.101), (0.08, 0.126)])
def test_it_keeps_the_distance_that_its_parameter_says(ros, simulation, distance, middle_m):
    sim = simulation(playground="base")
    sim.thymio.place(-0.35, -0.36, -0.3)
    ros.start(NODE, parameters={"distance": distance})
    sim.until(lambda: sim.thymio.pose.x_m > 0.0, seconds=8)
    settled = sim.now
    sim.until(lambda: sim.thymio.pose.x_m > 0.2, seconds=4)
    distances = [to_the_wall(moment.pose) for moment in sim.thymio.path if moment.at_s > settled]
    assert max(distances) - min(distances) < 0.005
    assert distances[-1] == pytest.approx(middle_m, abs=0.005)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2))
def test_it_finds_the_goal_of_the_maze(ros, simulation, seed):
    sim = simulation(playground="maze", seed=seed)
    ros.start(NODE)
    sim.until(reached(sim.thymio, (0.5, 0.5), tolerance=0.08), seconds=90)
