"""Both ways to a goal arrive; only the one by TF notices that the robot was carried away."""

from __future__ import annotations

import pytest

from thymio_sim_ros.testing import no_contact, reached

PACKAGE = "thymio_sim_ros.examples"
NODES = ("go_to_goal_odom", "go_to_goal_tf")
GOAL = (-0.3, 0.2)
PARAMETERS = {"goal_x": GOAL[0], "goal_y": GOAL[1]}


@pytest.mark.parametrize("name", NODES)
@pytest.mark.parametrize("seed", range(3))
def test_it_drives_to_the_goal_and_stays_there(ros, simulation, name, seed):
    sim = simulation(playground="base", seed=seed)
    ros.start(f"{PACKAGE}.{name}", parameters=PARAMETERS)
    sim.until(reached(sim.thymio, GOAL, tolerance=0.02), seconds=15)
    sim.step(1.0)
    assert reached(sim.thymio, GOAL, tolerance=0.02) & no_contact(sim.thymio)
    assert sim.thymio.speed == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize("name", NODES)
def test_a_robot_that_is_carried_away_arrives_by_tf_only(ros, simulation, name):
    sim = simulation(playground="base")
    ros.start(f"{PACKAGE}.{name}", parameters=PARAMETERS)
    sim.until(lambda: sim.thymio.pose.x_m < -0.1, seconds=10)
    sim.thymio.place(0.1, -0.3, 0.0)
    sim.step(15.0)
    assert sim.thymio.speed == pytest.approx(0.0, abs=1e-3)
    assert bool(reached(sim.thymio, GOAL, tolerance=0.02)) == (name == "go_to_goal_tf")
