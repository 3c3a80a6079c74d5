"""Follow a black line by the gray values of the two ground sensors.

Taught here: a gray value says more than "black" or "white": the difference of the two grows with the distance from the
line, so the robot steers smoothly; parameters that `ros2 param set` changes while the node runs.
"""

import rclpy
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float32

WHITE = 0.7  # if both sensors see more than this (0 black, 1 white), the line is lost
SEARCH_RAD_S = 1.5
PERIOD_S = 0.05


class LineFollower(Node):
    """Keeps both ground sensors above the line."""

    def __init__(self) -> None:
        super().__init__("line_follower")
        speeds = FloatingPointRange(from_value=0.0, to_value=0.12)
        gains = FloatingPointRange(from_value=0.0, to_value=20.0)
        about_speed = ParameterDescriptor(description="Speed along the line in m/s", floating_point_range=[speeds])
        about_gain = ParameterDescriptor(
            description="Turn in rad/s when one sensor sees black and the other white", floating_point_range=[gains]
        )
        self.declare_parameter("speed", 0.08, about_speed)
        self.declare_parameter("gain", 3.0, about_gain)
        self.left = self.right = 0.0
        self.side = 1.0  # where the line was last seen: 1 left, -1 right
        self.create_subscription(Float32, "ground/left/reflectance", self.on_left, 10)
        self.create_subscription(Float32, "ground/right/reflectance", self.on_right, 10)
        self.wheels = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(PERIOD_S, self.drive)

    def on_left(self, message: Float32) -> None:
        """Keep the latest gray value of the left sensor."""
        self.left = message.data

    def on_right(self, message: Float32) -> None:
        """Keep the latest gray value of the right sensor."""
        self.right = message.data

    def drive(self) -> None:
        """Turn toward the darker side; without a line, search where it was last seen."""
        command = Twist()
        if min(self.left, self.right) > WHITE:
            command.angular.z = self.side * SEARCH_RAD_S
        else:
            brighter_right = self.right - self.left
            if abs(brighter_right) > 0.1:
                self.side = 1.0 if brighter_right > 0 else -1.0
            command.linear.x = self.get_parameter("speed").value
            command.angular.z = self.get_parameter("gain").value * brighter_right
        self.wheels.publish(command)


def main() -> None:
    """Run the node until Ctrl-C."""
    try:
        rclpy.init()
        rclpy.spin(LineFollower())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
