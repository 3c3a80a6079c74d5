"""docs/ros.md lists the declarations of the nodes, and they are complete."""

from __future__ import annotations

from pathlib import Path

import pytest

from aseba_vm.targets import THYMIO_II
from thymio_sim_ros.ros import generate_ros_docs
from thymio_sim_ros.ros.interface import sensor_topics
from thymio_sim_ros.ros.interface.robot_inputs import robot_inputs

PAGE = Path(__file__).parent.parent.parent / "docs" / "ros.md"
COMMAND = "python -m thymio_sim_ros.ros.generate_ros_docs > docs/ros.md"


def test_the_page_is_what_the_nodes_declare():
    written, declared = PAGE.read_text(encoding="utf-8").splitlines(), generate_ros_docs.text().splitlines()
    differing = [line for line in declared if line not in written] + [line for line in written if line not in declared]
    assert written == declared, f"run {COMMAND}; differing: {differing[:4]}"


def test_every_topic_says_what_it_is_about():
    rows = [row for sensor in generate_ros_docs.own_sensors() for row in sensor_topics.rows_of(sensor)]
    assert [one.topic for one in (*rows, *robot_inputs()) if not one.about] == []


def test_no_topic_is_declared_twice():
    topics = [row.topic for sensor in generate_ros_docs.own_sensors() for row in sensor_topics.rows_of(sensor)]
    topics += [one.topic for one in robot_inputs()]
    assert sorted(topics) == sorted(set(topics))


@pytest.mark.parametrize("kind", ["variables", "local_events", "natives"])
def test_the_migration_names_all_that_a_program_knows(kind):
    page = generate_ros_docs.text().partition("## From Aseba to ROS")[2]
    names = [one.name for one in getattr(THYMIO_II, kind) if not one.name.startswith(("math.", "deque."))]
    assert [name for name in names if f"| `{name}" not in page] == []


@pytest.mark.parametrize(
    "line",
    [
        "| `button.center` | out | `buttons/center`, `_raw/buttons` |",
        "| `prox.horizontal[7]` | out | `proximity/…`, `_raw/proximity` |",
        "| `motor.left.target` | in | `_motor/target` |",
        "| `leds.top(red, green, blue)` | in | `led/body/top` |",
        "| `timer0` | | timers of your own node |",
    ],
)
def test_what_a_program_knows_is_found_on_topics(line):
    assert line in generate_ros_docs.text().splitlines()
