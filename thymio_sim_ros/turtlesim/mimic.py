"""Let a turtle drive as another one does, as the program of this name in turtlesim.

Remappings of `input/pose` and `output/cmd_vel` name the turtles.
"""

from __future__ import annotations

import rclpy
from geometry_msgs.msg import Twist
from rclpy.context import Context
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from turtlesim.msg import Pose

__all__ = ["Mimic", "main"]


class Mimic(Node):
    """Publishes the speeds of each pose as a velocity."""

    def __init__(self, context: Context | None = None) -> None:
        """`context`: the default one if None."""
        super().__init__("turtle_mimic", context=context)
        self._velocity = self.create_publisher(Twist, "output/cmd_vel", 1)
        self.create_subscription(Pose, "input/pose", self._follow, 1)

    def _follow(self, pose: Pose) -> None:
        velocity = Twist()
        velocity.linear.x = pose.linear_velocity
        velocity.angular.z = pose.angular_velocity
        self._velocity.publish(velocity)


def main() -> int:
    """Mimic until Ctrl-C; return the exit code."""
    try:
        rclpy.init()
        rclpy.spin(Mimic())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
