"""Drive to a goal by odometry: the point is in the frame `odom`, which begins where the robot started.

Taught here: a pose of `nav_msgs/Odometry`, the heading in a quaternion, and a rotation by hand from the frame `odom` to
the frame of the robot. Wheels slip, so odometry drifts; `go_to_goal_tf` drives to a point on the map instead.
"""

import math

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

ARRIVED_M = 0.01
TURN_RAD_S = 2.0  # at most


class GoToGoalOdom(Node):
    """Turns toward the goal, drives there and stops."""

    def __init__(self) -> None:
        super().__init__("go_to_goal_odom")
        meters = FloatingPointRange(from_value=-5.0, to_value=5.0)
        about_x = ParameterDescriptor(description="Goal in m, ahead of the start", floating_point_range=[meters])
        about_y = ParameterDescriptor(description="Goal in m, to the left of the start", floating_point_range=[meters])
        self.declare_parameter("goal_x", 0.3, about_x)
        self.declare_parameter("goal_y", 0.2, about_y)
        speeds = FloatingPointRange(from_value=0.0, to_value=0.1)
        self.declare_parameter("speed", 0.1, ParameterDescriptor(description="m/s", floating_point_range=[speeds]))
        self.wheels = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Odometry, "odom", self.on_odometry, 10)

    def on_odometry(self, message: Odometry) -> None:
        """Drive on each new pose, 20 times a second."""
        here, q = message.pose.pose.position, message.pose.pose.orientation
        yaw = math.atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))
        dx = self.get_parameter("goal_x").value - here.x
        dy = self.get_parameter("goal_y").value - here.y
        ahead = math.cos(yaw) * dx + math.sin(yaw) * dy  # the goal as the robot sees it
        left = -math.sin(yaw) * dx + math.cos(yaw) * dy
        self.drive(math.hypot(ahead, left), math.atan2(left, ahead))

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
        rclpy.spin(GoToGoalOdom())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
