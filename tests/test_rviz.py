"""The configuration of RViz: displays of RViz in Jazzy, on topics of this project, with compatible QoS."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("rclpy")

import yaml

from thymio_sim_ros.ros import generate_ros_docs

FILE = Path(__file__).parent.parent / "resource" / "rviz" / "thymio.rviz"
# The type that a display of Jazzy subscribes to; None: it has no topic of its own.
DISPLAYS = {
    "rviz_common/Group": None,
    "rviz_default_plugins/Grid": None,
    "rviz_default_plugins/TF": None,
    "rviz_default_plugins/LaserScan": "sensor_msgs/msg/LaserScan",
    "rviz_default_plugins/Map": "nav_msgs/msg/OccupancyGrid",
    "rviz_default_plugins/Marker": "visualization_msgs/msg/Marker",
    "rviz_default_plugins/MarkerArray": "visualization_msgs/msg/MarkerArray",
    "rviz_default_plugins/Odometry": "nav_msgs/msg/Odometry",
    "rviz_default_plugins/Range": "sensor_msgs/msg/Range",
    "rviz_default_plugins/RobotModel": "std_msgs/msg/String",
}
PANELS = {"rviz_common/Displays", "rviz_common/Tool Properties", "rviz_common/Views", "rviz_common/Time"}
TOOLS = {
    f"rviz_default_plugins/{name}"
    for name in ("Interact", "MoveCamera", "Select", "FocusCamera", "Measure", "SetInitialPose")
}


@pytest.fixture(scope="module")
def config() -> dict[str, Any]:
    loaded: dict[str, Any] = yaml.safe_load(FILE.read_text())
    return loaded


@pytest.fixture(scope="module")
def published() -> dict[str, tuple[str, str]]:
    return generate_ros_docs.published()


def _displays(entries: list[dict[str, Any]]) -> Iterator[dict[str, Any]]:
    for entry in entries:
        yield entry
        yield from _displays(entry.get("Displays", []))


def _all(config: dict[str, Any]) -> list[dict[str, Any]]:
    return list(_displays(config["Visualization Manager"]["Displays"]))


def _topic(display: dict[str, Any]) -> dict[str, Any] | None:
    return display.get("Description Topic") or display.get("Topic")


def test_every_class_is_one_of_jazzy(config):
    manager = config["Visualization Manager"]
    assert {panel["Class"] for panel in config["Panels"]} <= PANELS
    assert {display["Class"] for display in _all(config)} <= DISPLAYS.keys()
    assert {tool["Class"] for tool in manager["Tools"]} <= TOOLS
    assert manager["Views"]["Current"]["Class"] == "rviz_default_plugins/Orbit"
    assert manager["Transformation"]["Current"]["Class"] == "rviz_default_plugins/TF"


def test_every_display_shows_a_topic_of_its_type_with_the_durability_it_has(config, published):
    shown = {}
    for display in _all(config):
        topic = _topic(display)
        if topic is None:
            assert DISPLAYS[display["Class"]] is None
            continue
        is_transient_local = topic["Durability Policy"] == "Transient Local"
        assert topic["Reliability Policy"] == "Reliable"
        shown[topic["Value"]] = (DISPLAYS[display["Class"]], "transient local" if is_transient_local else "volatile")
    kinds = {
        name: (kind, profile if profile == "transient local" else "volatile")
        for name, (kind, profile) in published.items()
    }
    assert shown == {name: kinds.get(name) for name in shown}


def test_robot_playground_objects_ranges_and_odometry_are_shown_by_default(config):
    enabled = {(_topic(display) or {}).get("Value") for display in _all(config) if display["Enabled"]}
    sides = ("left", "center_left", "center", "center_right", "right", "rear_left", "rear_right")
    wanted = {"robot_description", "/_markers", "/_markers/objects", "odom", *(f"proximity/{side}" for side in sides)}
    assert wanted <= enabled
    assert config["Visualization Manager"]["Global Options"]["Fixed Frame"] == "map"


def test_the_pose_tool_moves_the_robot(config):
    (tool,) = [tool for tool in config["Visualization Manager"]["Tools"] if tool["Class"].endswith("SetInitialPose")]
    assert tool["Topic"]["Value"] == "initialpose"


def test_names_are_relative_but_those_of_the_whole_world(config):
    names = {topic["Value"] for display in _all(config) if (topic := _topic(display))}
    assert {name for name in names if name.startswith("/")} == {"/_markers", "/_markers/objects", "/map"}
