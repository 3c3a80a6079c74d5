"""What `ros2 topic list` shows of the suite: a short list, and nothing that is made for tools (docs/ros.md)."""

from __future__ import annotations

import pytest

from tests.processes import free_port
from thymio_sim_ros.ros import combined
from thymio_sim_ros.ros.interface.names import PROXIMITY, is_hidden
from thymio_sim_ros.suite_config import SuiteConfig

MOST = 40
"""Topics that a student may meet at first, those of ROS itself included."""

NEEDED = {
    "/cmd_vel",
    "/odom",
    "/imu",
    "/pen/down",
    "/sound/tone",
    "/led/circle",
    "/robot_description",
    *(f"/proximity/{name}" for name in PROXIMITY),
    *(f"/ground/{side}" for side in ("left", "right")),
    *(f"/buttons/{button}" for button in ("forward", "backward", "left", "right", "center")),
    *(f"/led/body/{part}" for part in ("top", "bottom_left", "bottom_right")),
    *(f"/aseba/{way}/{event}" for way in ("events", "emit") for event in ("line", "speed")),
}
OF_ROS = {"/clock", "/diagnostics", "/parameter_events", "/rosout", "/tf", "/tf_static"}
FOR_TOOLS = {
    "/_aseba/status",
    "/_aseba/target",
    "/_led/own",
    "/_markers",
    "/_press/tap",
    "/_raw/ground",
    "/_sound/state",
    "/_sound/state/wave",
    "/simulator/_state",
}


@pytest.fixture
def topics(ros):
    """Names of all topics of the suite as `thymio-sim` starts it, page and bridge included."""
    suite_nodes = combined.suite_nodes(
        ros.context, SuiteConfig(program="line_follower", port=0, foxglove_port=free_port())
    )
    for life in suite_nodes:
        ros.live(life)
    ros.until(lambda: set(_names(ros)) >= FOR_TOOLS | NEEDED, what="the topics of all nodes")
    return _names(ros)


def _names(ros):
    return [name for name, _ in ros.node.get_topic_names_and_types()]


def test_a_student_meets_at_most_forty_topics(topics):
    shown = {name for name in topics if not is_hidden(name)}
    assert shown >= NEEDED | OF_ROS
    assert len(shown) <= MOST, sorted(shown)


def test_all_topics_exist_before_there_are_subscribers(topics):
    assert len(topics) > 100


@pytest.mark.parametrize(
    ("topic", "hidden"),
    [("/odom", False), ("/a_/odom_", False), ("/_raw/ground", True), ("/anna/led/_own", True), ("_tap", True)],
)
def test_a_word_that_begins_with_an_underscore_hides_a_name(topic, hidden):
    assert is_hidden(topic) is hidden
