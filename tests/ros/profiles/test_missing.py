"""What a profile cannot give: a node that asks for it gets one sentence with the reason, whatever it asks with."""

from __future__ import annotations

import pytest
from geometry_msgs.msg import PoseStamped
from nav_msgs.srv import GetPlan
from rclpy.action import ActionClient
from sensor_msgs.msg import CameraInfo, Image
from std_srvs.srv import Empty
from test_msgs.action import Fibonacci

from tests.ros.rclpy_ext.test_connections import beaten


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
    ],
)
def test_the_reason_is_given(ros, simulation, strange_node, like, ask, reason):
    simulator = simulation(like=like).simulator
    asked = ask(strange_node("student"))
    ros.until(lambda: any(reason in str(one) for one in beaten(simulator)))
    found = [str(one) for one in beaten(simulator) if "by node /student" in str(one)]
    assert len(found) == 1, found
    del asked
