"""Reports of the collision sensor."""

from __future__ import annotations

from tests.sim.builders import FLOOR, make, post_wall, readings, run, send
from thymio_sim_ros.sim.commands import MotorTargets
from thymio_sim_ros.sim.world import World


def test_contact_is_published_at_the_start_and_on_change() -> None:
    world = World(make([FLOOR, post_wall(0.05)]), noise=False)
    send(world, MotorTargets(300, 300))
    there = [reading.is_touching for reading in readings(run(world, 2.0), "collision")]
    send(world, MotorTargets(-300, -300))
    back = [reading.is_touching for reading in readings(run(world, 2.0), "collision")]
    assert (there, back) == ([False, True], [False])
