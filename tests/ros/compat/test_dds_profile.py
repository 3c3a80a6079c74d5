"""The profile of a process that a node has to itself."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from thymio_sim_ros.ros.compat import dds_profile

MEET = """
import contextlib, sys
import rclpy
from rclpy.context import Context
from rclpy.node import Node
from std_msgs.msg import Empty
from thymio_sim_ros.ros.compat import dds_profile

with dds_profile.alone() if sys.argv[1] == "alone" else contextlib.nullcontext():
    context = Context()
    rclpy.init(args=[], context=context)
    node = Node("node", context=context)
    publisher = node.create_publisher(Empty, "topic", 1)
    node.create_subscription(Empty, "topic", print, 1)
    print("matched", publisher.get_subscription_count())
    node.destroy_node()
    context.try_shutdown()
"""


def matched(folder: Path, how: str) -> str:
    """Endpoints of a process that publishes and subscribes to a topic."""
    run = subprocess.run([sys.executable, "-c", MEET, how], cwd=folder, capture_output=True, text=True, check=True)
    return run.stdout.strip()


def test_endpoints_of_a_process_with_the_profile_do_not_match(tmp_path: Path) -> None:
    assert matched(tmp_path, "alone") == "matched 0"
    assert matched(tmp_path, "together") == "matched 1"


def test_the_environment_is_as_before_afterwards() -> None:
    environment: dict[str, str] = {}
    with dds_profile.alone(environment):
        assert environment == {dds_profile.VARIABLE: str(dds_profile.PROFILE)}
    assert environment == {}


@pytest.mark.parametrize(
    "name", [dds_profile.VARIABLE, "FASTDDS_DEFAULT_PROFILES_FILE", "RMW_FASTRTPS_USE_QOS_FROM_XML"]
)
def test_a_profile_of_the_user_has_priority(name: str) -> None:
    environment = {name: "theirs"}
    with dds_profile.alone(environment):
        assert environment == {name: "theirs"}
    assert environment == {name: "theirs"}


def test_a_profile_in_the_working_folder_has_priority(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "DEFAULT_FASTRTPS_PROFILES.xml").touch()
    environment: dict[str, str] = {}
    with dds_profile.alone(environment):
        assert environment == {}
