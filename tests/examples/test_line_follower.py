"""The line follower: a lap, a lost line, and a parameter that is changed while it drives."""

from __future__ import annotations

import pytest
from rclpy.parameter import Parameter

from tests.seeds import seeds
from thymio_sim_ros.testing import followed_line, no_contact, slower_than

NODE = "thymio_sim_ros.examples.line_follower"
pytestmark = pytest.mark.thymio(playground="line")


@pytest.mark.parametrize("seed", seeds(2))
def test_it_follows_the_line_for_a_lap(ros, simulation, seed):
    sim = simulation()
    ros.start(NODE)
    sim.until(followed_line(sim.thymio, within=0.015), seconds=60)
    assert no_contact(sim.thymio) & slower_than(sim.thymio, 0.1)


@pytest.mark.parametrize("turned", [0.35, -0.35])
def test_it_turns_back_to_a_line_that_it_is_about_to_leave(ros, simulation, turned):
    sim = simulation()
    sim.thymio.place(-0.15, -0.38, turned)
    ros.start(NODE)
    sim.until(followed_line(sim.thymio, laps=0.15, within=0.05), seconds=20)


def test_its_speed_can_be_changed_while_it_drives_but_only_within_its_range(ros, simulation):
    sim = simulation()
    node = ros.start(NODE)
    sim.until(lambda: sim.thymio.speed > 0.07, seconds=2)
    (refused,) = node.set_parameters([Parameter("speed", value=1.0)])
    (taken,) = node.set_parameters([Parameter("speed", value=0.03)])
    assert (refused.successful, taken.successful) == (False, True)
    sim.until(lambda: sim.thymio.speed < 0.035, seconds=2)
