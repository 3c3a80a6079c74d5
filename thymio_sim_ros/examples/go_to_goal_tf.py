"""Drive to a goal by TF: the point is on the map, and tf2 says where it is as the robot sees it.

Taught here: a buffer and a listener, a transform that is not available yet, and a point that is transformed from `map`
to `base_link` in one line. Compare with `go_to_goal_odom`, which computes the same by hand, and drifts.
"""

import math

import rclpy
from geometry_msgs.msg import PointStamped, Twist
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

from thymio_sim_ros.tf import Buffer, TransformException, TransformListener

ARRIVED_M = 0.01
TURN_RAD_S = 2.0  # at most
PERIOD_S = 0.05


class GoToGoalTf(Node):
    """Turns toward the goal, drives there and stops."""

    def __init__(self) -> None:
        super().__init__("go_to_goal_tf")
        meters = FloatingPointRange(from_value=-5.0, to_value=5.0)
        about_x = ParameterDescriptor(description="Goal on the map: x in m", floating_point_range=[meters])
        about_y = ParameterDescriptor(description="Goal on the map: y in m", floating_point_range=[meters])
        self.declare_parameter("goal_x", 0.3, about_x)
        self.declare_parameter("goal_y", 0.2, about_y)
        speeds = FloatingPointRange(from_value=0.0, to_value=0.1)
        self.declare_parameter("speed", 0.1, ParameterDescriptor(description="m/s", floating_point_range=[speeds]))
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.wheels = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(PERIOD_S, self.look)

    def look(self) -> None:
        """Drive by the latest transform, 20 times a second."""
        goal = PointStamped()  # its stamp is 0: the latest transform is used
        goal.header.frame_id = "map"
        goal.point.x = self.get_parameter("goal_x").value
        goal.point.y = self.get_parameter("goal_y").value
        try:
            seen = self.buffer.transform(goal, "base_link").point
        except TransformException as error:
            self.get_logger().info(f"not yet: {error}", throttle_duration_sec=2.0)
            return
        self.drive(math.hypot(seen.x, seen.y), math.atan2(seen.y, seen.x))

    def drive(self, distance: float, angle: float) -> None:
        """Turn toward the goal; drive once it is ahead, slowly near it."""
        command = Twist()
        if distance > ARRIVED_M:
            command.angular.z = max(-TURN_RAD_S, min(TURN_RAD_S, 3.0 * angle))
            if abs(angle) < 0.4:
                command.linear.x = min(self.get_parameter("speed").value, distance + 0.02)
        else:
            self.get_logger().info("arrived", once=True)
        self.wheels.publish(command)


def main() -> None:
    """Run the node until Ctrl-C."""
    try:
        rclpy.init()
        rclpy.spin(GoToGoalTf())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
