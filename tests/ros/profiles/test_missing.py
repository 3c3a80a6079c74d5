"""What a profile cannot give: a node that asks for it gets one sentence with the reason, whatever it asks with.

That each type of the other robot is there or missing on purpose follows from the definitions of its package.
"""

from __future__ import annotations

import pytest
from geometry_msgs.msg import PoseStamped
from nav_msgs.srv import GetPlan
from rcl_interfaces.msg import Log
from rcl_interfaces.srv import GetParameters, SetParameters
from rclpy.action import ActionClient
from rclpy.parameter import Parameter
from sensor_msgs.msg import CameraInfo, Image
from std_srvs.srv import Empty
from test_msgs.action import Fibonacci

from tests.ros.rclpy_ext.test_connections import beaten
from thymio_sim_ros.portable_ros.messages import interface_files
from thymio_sim_ros.ros.profiles import Profile, named

PACKAGES = {"turtlesim": "turtlesim", "turtlebot3": "turtlebot3_msgs", "create3": "irobot_create_msgs"}
"""The package with the types of a profile's robot."""
NOT_OF_A_ROBOT = {
    "turtlebot3_msgs/action/Patrol": "of the examples patrol server and client",
    "turtlebot3_msgs/msg/Sound": "of ROS 1; now it is a service",
    "turtlebot3_msgs/msg/VersionInfo": "of ROS 1",
    "turtlebot3_msgs/srv/Dqn": "between the nodes of the examples for reinforcement learning",
    "turtlebot3_msgs/srv/Goal": "between the nodes of the examples for reinforcement learning",
}
"""Types that no topic, service or action of the robot has, with what they are for."""


def rows_of(profile: Profile):
    return (*profile.topics, *profile.inputs, *profile.services, *profile.actions)


def used_types(name: str) -> set[str]:
    """A type of the graph's definitions, and those of its fields."""
    found = {name}
    for section in interface_files.sections(name).values():
        for line in section.text.splitlines():
            field = line.partition("#")[0].split(maxsplit=1)
            short = field[0].partition("[")[0] if field else ""
            package, _, own = short.rpartition("/")
            inner = f"{package or name.partition('/')[0]}/msg/{own}"
            if interface_files.is_package(inner.partition("/")[0]) and interface_files.sections(inner):
                found |= used_types(inner)
    return found


@pytest.mark.parametrize("like", PACKAGES)
def test_each_type_of_the_robot_is_there_or_missing_on_purpose(like):
    profile, package = named(like), PACKAGES[like]
    there = {used for row in rows_of(profile) for used in used_types(row.type)}
    missing = {used for one in profile.missing if one.type for used in used_types(one.type)}
    of_package = {f"{package}/{short}" for short in interface_files.interfaces(package)}
    assert of_package - there - missing - NOT_OF_A_ROBOT.keys() == set()
    assert {one.type for one in profile.missing if one.type} - of_package == set()
    assert not there & ({one.type for one in profile.missing} | NOT_OF_A_ROBOT.keys())


@pytest.mark.parametrize("like", PACKAGES)
def test_nothing_is_there_and_missing(like):
    profile = named(like)
    names = {getattr(row, "topic", None) or row.name for row in rows_of(profile)}
    assert not names & {one.name.strip("/") for one in profile.missing}
    own = {row.name for row in profile.node_parameters}
    assert not own & {one.name for one in profile.missing_parameters}


@pytest.mark.parametrize(
    ("like", "name", "reason"),
    [
        ("turtlesim", "holonomic", "A Thymio cannot drive sideways"),
        ("create3", "reflexes.REFLEX_BUMP", "has no reflexes: react to hazard_detection"),
        ("create3", "max_speed", "at most 0.166 m/s"),
    ],
)
def test_a_parameter_of_the_other_robot_is_refused_with_the_reason(simulation, like, name, reason):
    node = simulation(like=like).simulator._profile.node
    result = node.set_parameters_atomically([Parameter(name, value=True)])
    assert not result.successful
    assert result.reason.startswith(f"{name}: ")
    assert reason in result.reason


def test_a_topic_may_have_the_name_of_a_missing_node():
    profile = named("create3")
    assert profile.missing_name("/robot_state") == ""
    assert profile.missing_name("/robot_state/") == profile.missing_name("/robot_state/get_parameters") != ""


def test_a_start_value_of_such_a_parameter_is_answered_too(ros, simulator_with):
    simulator_with("-p", "turtlesim:holonomic:=true", profile=named("turtlesim"))
    said = ros.collect(Log, "/rosout", where=lambda log: "holonomic" in log.msg)
    ros.until(lambda: said)
    assert said[0].msg.startswith("parameter holonomic has no effect: A Thymio cannot drive sideways")


def subscriber(kind, topic):
    return lambda node: node.create_subscription(kind, topic, lambda _message: None, 1)


def publisher(kind, topic):
    return lambda node: node.create_publisher(kind, topic, 1)


def client(kind, service):
    return lambda node: node.create_client(kind, service)


def action_client(action):
    return lambda node: ActionClient(node, Fibonacci, action)


@pytest.mark.parametrize(
    ("like", "ask", "reason"),
    [
        ("turtlebot3", subscriber(Image, "/camera/image_raw"), "The simulated robot has no camera."),
        ("turtlebot3", subscriber(Image, "image_raw"), "The simulated robot has no camera."),
        ("turtlebot3", subscriber(CameraInfo, "/camera/camera_info"), "The simulated robot has no camera."),
        ("turtlebot3", publisher(PoseStamped, "/goal_pose"), "Nav2 does not run here: use navigate_to_position"),
        ("turtlebot3", action_client("navigate_to_pose"), "Nav2 does not run here: use navigate_to_position"),
        ("turtlebot3", client(Empty, "/reinitialize_global_localization"), "Nav2 does not run here"),
        ("turtlebot3", client(Empty, "/pause_physics"), "Gazebo does not run here: call /simulator/pause"),
        ("turtlebot3", client(GetPlan, "/gazebo/get_entity_state"), "use /simulator/get_poses"),
        ("create3", subscriber(Image, "/mouse"), "has no optical mouse sensor; use odom"),
        ("create3", client(Empty, "robot_power"), "cannot be switched off by ROS; end thymio-sim"),
        ("create3", client(SetParameters, "/ui_mgr/set_parameters"), "/motion_control and /simulator have parameters"),
        ("create3", client(SetParameters, "/r1/motion_control/set_parameters"), "without the name of a robot"),
        ("turtlebot3", client(GetParameters, "/turtlebot3_node/get_parameters"), "/simulator has parameters"),
    ],
)
def test_the_reason_is_given(ros, simulation, strange_node, like, ask, reason):
    simulator = simulation(like=like).simulator
    asked = ask(strange_node("student"))
    ros.until(lambda: any(reason in str(one) for one in beaten(simulator)))
    found = [str(one) for one in beaten(simulator) if "by node /student" in str(one)]
    assert len(found) == 1, found
    del asked
