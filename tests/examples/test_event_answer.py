"""The program of docs/course-nodes.md asks, the node answers."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from std_msgs.msg import Int16MultiArray

from thymio_sim_ros.testing import emitted, shows

NODE = "thymio_sim_ros.examples.event_answer"
PAGE = Path(__file__).parents[2] / "docs" / "course-nodes.md"
PROGRAM = re.search(r"`where.aesl`:\n\n```xml\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)[1]


@pytest.mark.parametrize("seed", range(2))
def test_a_program_that_asks_where_it_is_drives_20_cm(ros, simulation, runtime, seed):
    sim = simulation(playground="base", seed=seed)
    runtime(PROGRAM)
    ros.start(NODE)
    sim.thymio.touch("center")
    sim.until(shows(sim.thymio, "top", "green"), seconds=10)
    sim.step(0.5)
    assert emitted(sim.thymio, "where")
    assert sim.thymio.speed == pytest.approx(0.0, abs=1e-3)
    assert 0.2 <= sim.thymio.pose.x_m < 0.22


def test_without_the_node_it_does_not_stop(ros, simulation, runtime):
    sim = simulation(playground="base")
    runtime(PROGRAM)
    sim.thymio.touch("center")
    sim.until(lambda: sim.thymio.pose.x_m > 0.3, seconds=10)
    assert not shows(sim.thymio, "top", "green")


def test_an_answer_has_the_position_in_the_units_of_the_parameter(ros, simulation, runtime):
    sim = simulation(playground="base")
    runtime(PROGRAM)
    ros.start(NODE, parameters={"units_per_meter": 100.0})
    answers = ros.collect(Int16MultiArray, "aseba/emit/here")
    sim.thymio.touch("center")
    sim.until(lambda: sim.thymio.pose.x_m > 0.1, seconds=10)
    assert list(answers.latest.data) in ([9, 0], [10, 0])
