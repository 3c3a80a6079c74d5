"""The DDS profiles of this package's processes."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

from thymio_sim_ros.ros.compat import dds_profile

MEET = """
import sys
import rclpy
from rclpy.context import Context
from rclpy.node import Node
from std_msgs.msg import Empty
from thymio_sim_ros.ros.compat import dds_profile

with dds_profile.used(getattr(dds_profile, sys.argv[1])):
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


def test_endpoints_of_a_process_match_unless_its_profile_says_otherwise(tmp_path: Path) -> None:
    assert matched(tmp_path, "ALONE") == "matched 0"
    assert matched(tmp_path, "ANNOUNCING") == "matched 1"


@pytest.mark.parametrize("profile", [dds_profile.ALONE, dds_profile.ANNOUNCING, dds_profile.LOOPBACK])
def test_all_profiles_announce_participants_more_often_than_every_three_seconds(profile: Path) -> None:
    """A profile that cannot be parsed is ignored by Fast DDS."""
    name = "{http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles}"
    (period,) = ElementTree.parse(profile).getroot().iter(f"{name}leaseAnnouncement")
    seconds, nanoseconds = (int(part.text or "") for part in period)
    assert seconds + nanoseconds / 1e9 <= 0.5


@pytest.mark.parametrize("before", [{}, {dds_profile.VARIABLE: str(dds_profile.ANNOUNCING)}])
def test_the_environment_is_as_before_afterwards(before: dict[str, str]) -> None:
    environment = dict(before)
    with dds_profile.used(dds_profile.ALONE, environment) as is_used:
        assert is_used
        assert environment == {dds_profile.VARIABLE: str(dds_profile.ALONE)}
    assert environment == before


@pytest.mark.parametrize(
    "name", [dds_profile.VARIABLE, "FASTDDS_DEFAULT_PROFILES_FILE", "RMW_FASTRTPS_USE_QOS_FROM_XML"]
)
def test_a_profile_of_the_user_has_priority(name: str) -> None:
    environment = {name: "theirs"}
    with dds_profile.used(dds_profile.ALONE, environment) as is_used:
        assert not is_used
        assert environment == {name: "theirs"}
    assert environment == {name: "theirs"}


def test_a_profile_in_the_working_folder_has_priority(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "DEFAULT_FASTRTPS_PROFILES.xml").touch()
    environment: dict[str, str] = {}
    with dds_profile.used(dds_profile.ALONE, environment) as is_used:
        assert not is_used
        assert environment == {}


def test_another_rmw_keeps_its_own_settings(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dds_profile, "get_rmw_implementation_identifier", lambda: "rmw_cyclonedds_cpp")
    environment: dict[str, str] = {}
    with dds_profile.used(dds_profile.ALONE, environment) as is_used:
        assert not is_used
        assert environment == {}


def test_another_rmw_gets_no_profile_without_shared_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dds_profile, "get_rmw_implementation_identifier", lambda: "rmw_cyclonedds_cpp")
    assert dds_profile.for_this_machine(shared_memory=False) == {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
