"""Profiles as plug-ins: what is wrong with one, what is missing on purpose, and one of another package."""

from __future__ import annotations

from dataclasses import replace

import pytest
from rcl_interfaces.msg import Log
from std_msgs.msg import Float64
from std_srvs.srv import Trigger

from tests import plugin_page
from thymio_sim_ros.portable_ros.import_hook import is_served
from thymio_sim_ros.ros.foxglove.types import MissingTypeError
from thymio_sim_ros.ros.profiles import ParameterRow, Profile, ProfileError, TopicRow, all_profiles, named
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError
from thymio_sim_ros.ros.simulator.node import Simulator, SimulatorParams
from thymio_sim_ros.ros.simulator.profile import types
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


@pytest.fixture
def installed(monkeypatch):
    """Let a ROS 2 be installed that has the standard packages and some others.

    No wheel has the packages of other robots, and their classes cannot be used without compiled libraries, so what is
    replaced is the search for a class.
    """

    def install(*others):
        def load(name):
            package = name.partition("/")[0]
            if package not in {"geometry_msgs", "sensor_msgs", "std_msgs", "std_srvs", *others}:
                raise MissingTypeError(name, f"there is no package {package}")
            return name

        monkeypatch.setattr(types, "load_type", load)
        monkeypatch.setattr(types.import_hook, "is_served", lambda _name: False)

    return install


@pytest.mark.parametrize("like", ["turtlesim", "turtlebot3", "create3"])
def test_an_installed_ros_with_the_packages_has_all_rows(installed, like):
    installed("turtlesim", "turtlebot3_msgs", "irobot_create_msgs")
    found = usable(named(like))
    assert found.profile == named(like)
    assert found.left_out == ()
    assert found.types["geometry_msgs/msg/Twist" if like == "turtlesim" else "sensor_msgs/msg/Imu"]


@pytest.mark.parametrize(
    ("like", "others", "left_out"),
    [
        (
            "turtlesim",
            (),
            "pose, color_sensor, spawn, kill, set_pen, teleport_absolute, teleport_relative, rotate_absolute left out,"
            " since turtlesim is not installed in this ROS 2: install ros-<distribution>-turtlesim, or use the embedded"
            " graph, which has its types (--portable)",
        ),
        (
            "turtlebot3",
            ("irobot_create_msgs",),
            "sensor_state, sound left out, since turtlebot3_msgs is not installed in this ROS 2: install"
            " ros-<distribution>-turtlebot3-msgs, or use the embedded graph, which has its types (--portable)",
        ),
        (
            "turtlebot3",
            (),
            "sensor_state, sound, rotate_angle, drive_distance, navigate_to_position left out, since turtlebot3_msgs"
            " and irobot_create_msgs are not installed in this ROS 2: install ros-<distribution>-turtlebot3-msgs and"
            " ros-<distribution>-irobot-create-msgs, or use the embedded graph, which has their types (--portable)",
        ),
    ],
)
def test_an_installed_ros_without_them_says_which_rows_are_left_out(installed, like, others, left_out):
    installed(*others)
    found = usable(named(like))
    assert found.left_out == (f"--like {like}: {left_out}",)
    kept = found.profile
    assert all(row.type in found.types for row in (*kept.topics, *kept.inputs, *kept.services, *kept.actions))


def test_a_profile_without_any_row_left_is_refused(installed):
    installed()
    profile = replace(PLAIN, topics=(replace(ROW, type="rover_msgs/msg/Place"),))
    with pytest.raises(ProfileError, match=r"Place is not available: .* expected the package rover_msgs"):
        usable(profile)


def test_the_embedded_graph_is_named_only_if_it_has_the_types(installed):
    installed()
    found = usable(replace(PLAIN, topics=(ROW, replace(ROW, topic="site", type="rover_msgs/msg/Place"))))
    assert found.left_out == (
        "--like plain: site left out, since rover_msgs is not installed in this ROS 2: install"
        " ros-<distribution>-rover-msgs",
    )


@pytest.mark.parametrize(
    ("profile", "reason"),
    [
        (replace(PLAIN, topics=(replace(ROW, topic="odom"),)), "found 'odom', which the robot itself has"),
        (
            replace(PLAIN, topics=(ROW, replace(ROW, topic="site", type="std_msgs/msg/Flot64"))),
            "found no type std_msgs/msg/Flot64, expected 'std_msgs/msg/Float64'",
        ),
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
