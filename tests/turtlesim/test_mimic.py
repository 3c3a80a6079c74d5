"""mimic: the speeds of one turtle become the velocity of another."""

from __future__ import annotations

from geometry_msgs.msg import Twist, Vector3

from tests import ros_graph

pytestmark = ros_graph.needs_package("turtlesim")

mimic = ros_graph.module("thymio_sim_ros.turtlesim.mimic")
msg = ros_graph.module("turtlesim.msg")


def test_the_speeds_of_a_pose_are_published_as_a_velocity(ros):
    node = ros.add(mimic.Mimic(ros.context))
    assert node.get_name() == "turtle_mimic"
    velocities = ros.collect(Twist, "/output/cmd_vel")
    ros.publisher(msg.Pose, "/input/pose").publish(msg.Pose(x=3.0, linear_velocity=1.5, angular_velocity=-0.5))
    ros.until(lambda: velocities)
    assert velocities[-1] == Twist(linear=Vector3(x=1.5), angular=Vector3(z=-0.5))
