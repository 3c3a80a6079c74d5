"""A ROS node that publishes a velocity, as `ros2 topic pub` does: `velocity_node TOPIC RATE LINEAR_X`."""

from __future__ import annotations

import contextlib
import sys

import rclpy
from geometry_msgs.msg import Twist, Vector3
from rclpy.executors import ExternalShutdownException


def main() -> None:
    """Publish until Ctrl-C."""
    topic, rate_hz, linear_x = sys.argv[1:]
    rclpy.init()
    node = rclpy.create_node("velocity")
    publisher = node.create_publisher(Twist, topic, 10)
    twist = Twist(linear=Vector3(x=float(linear_x)))
    node.create_timer(1 / float(rate_hz), lambda: publisher.publish(twist))
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(node)
