"""Profiles as plug-ins: what is wrong with one, what is missing on purpose, and one of another package."""

from __future__ import annotations

from dataclasses import replace

import pytest
from rcl_interfaces.msg import Log
from std_msgs.msg import Float64
from std_srvs.srv import Trigger

from tests import plugin_page
from thymio_sim_ros.portable_ros.import_hook import is_served
from thymio_sim_ros.ros.profiles import ParameterRow, Profile, ProfileError, TopicRow, all_profiles, named
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError
from thymio_sim_ros.ros.simulator.node import Simulator, SimulatorParams
from thymio_sim_ros.ros.simulator.profile.types import usable

ROW = TopicRow("place", "std_msgs/msg/Float64", "pose", lambda kind, reading, _robot: kind(data=reading.truth.x_m))
PLAIN = Profile("plain", "a robot with a place", topics=(ROW,))


@pytest.fixture
def rover(tmp_path, monkeypatch):
    with plugin_page.installed(tmp_path, plugin_page.files(), monkeypatch):
        yield


def test_every_profile_can_be_used_or_says_what_is_not_installed():
    for profile in all_profiles():
        found = usable(profile)
        assert (found.profile == profile) == (not found.left_out)
        assert found.profile == profile or not is_served("rclpy")


def test_an_unknown_profile_has_the_nearest_one():
    with pytest.raises(ProfileError, match="found no robot 'turtelsim', expected 'turtlesim'"):
        named("turtelsim")


@pytest.mark.parametrize(
    ("profile", "reason"),
    [
        (replace(PLAIN, topics=(replace(ROW, topic="odom"),)), "found 'odom', which the robot itself has"),
        (replace(PLAIN, topics=(ROW, ROW)), "found 'place' twice"),
        (replace(PLAIN, node="web_ui"), "found the node 'web_ui', which the suite has already"),
        (replace(PLAIN, replaces=frozenset({"odo"})), "found 'odo' among the names that it replaces"),
        (
            replace(PLAIN, topics=(replace(ROW, type="rover_msgs/msg/Place"),)),
            "type rover_msgs/msg/Place is not available: .* expected the package rover_msgs",
        ),
    ],
)
def test_what_is_wrong_with_a_profile_is_said_before_anything_starts(ros, profile, reason):
    with pytest.raises(StartError, match=f"--like plain: {reason}"):
        Simulator(ros.context, SimulatorParams(), profile=profile)


def test_parameters_need_a_node():
    with pytest.raises(ValueError, match="expected the name of the node"):
        replace(PLAIN, node_parameters=(ParameterRow("speed", 1.0),))


def test_a_profile_without_a_node_has_its_topics_on_the_simulator(ros):
    ros.live(Simulator(ros.context, SimulatorParams(start_paused=True), profile=PLAIN))
    assert ("/place", ["std_msgs/msg/Float64"]) in ros.node.get_publisher_names_and_types_by_node("simulator", "/")


@pytest.mark.usefixtures("rover")
def test_one_of_another_package_joins(ros, simulation):
    sim = simulation(like="rover")
    headings = ros.collect(Float64, "/heading")
    ros.publisher(Float64, "/drive").publish(Float64(data=10.0))
    sim.until(lambda: sim.thymio.pose.x_m > 0.02)
    assert headings[-1].data == pytest.approx(0.0, abs=5.0)
    client = ros.node.create_client(Trigger, "/stop")
    ros.until(client.service_is_ready)
    assert ros.until(client.call_async(Trigger.Request()).result).success
    sim.step(0.1)
    at = sim.thymio.pose.x_m
    sim.step(0.3)
    assert sim.thymio.pose.x_m == pytest.approx(at, abs=0.002)


@pytest.mark.usefixtures("rover")
def test_who_asks_for_what_is_missing_is_told_once(ros, simulation):
    simulator = simulation(like="rover").simulator
    logged = ros.collect(Log, "/rosout")
    ros.node.create_publisher(Float64, "/arm", 1)
    sentence = "A Thymio has no arm."

    def warnings():
        simulator._connections.poll()
        return [line for line in logged if sentence in line.msg]

    ros.until(warnings)
    (line,) = warnings()
    assert line.msg.startswith("/arm has a publisher of std_msgs/msg/Float64 by node")
