"""Follow a wall on the right-hand side, at a distance measured by one sensor.

Taught here: several subscriptions with one callback, a control loop on a timer, a proportional controller, and what
REP 117 is good for: "no obstacle" is +inf and "too close" is -inf, so the controller needs no special case for either.
"""

import math
from functools import partial

import rclpy
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import Range

TURN_RAD_S = 1.2  # to the left, at most
ARC_M = 0.1  # radius of the arc to the right, where the wall ends
GAIN = 20.0  # rad/s for each meter of error
PERIOD_S = 0.05


class WallFollower(Node):
    """Drives straight until it meets a wall, then keeps the wall on its right."""

    def __init__(self) -> None:
        super().__init__("wall_follower")
        speeds = FloatingPointRange(from_value=0.0, to_value=0.12)
        distances = FloatingPointRange(from_value=0.03, to_value=0.12)
        about_speed = ParameterDescriptor(description="Speed along the wall in m/s", floating_point_range=[speeds])
        about_distance = ParameterDescriptor(
            description="Distance in m from the right sensor to the wall", floating_point_range=[distances]
        )
        self.declare_parameter("speed", 0.08, about_speed)
        self.declare_parameter("distance", 0.06, about_distance)
        self.has_met_wall = False
        self.ranges = dict.fromkeys(("center", "center_right", "right"), math.inf)
        for name in self.ranges:
            self.create_subscription(Range, f"proximity/{name}", partial(self.on_range, name), 10)
        self.wheels = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(PERIOD_S, self.drive)

    def on_range(self, name: str, message: Range) -> None:
        """Keep the latest distance of one sensor."""
        self.ranges[name] = message.range

    def drive(self) -> None:
        """Decide from the latest distances."""
        speed, distance = self.get_parameter("speed").value, self.get_parameter("distance").value
        command = Twist()
        right, ahead = self.ranges["right"], min(self.ranges["center"], self.ranges["center_right"])
        self.has_met_wall = self.has_met_wall or min(right, ahead) < distance
        if ahead < distance:
            command.angular.z = TURN_RAD_S  # a wall ahead: turn left on the spot
        else:
            command.linear.x = speed
            if self.has_met_wall:
                turn = GAIN * (distance - right)  # -inf where the wall ends
                command.angular.z = max(-speed / ARC_M, min(TURN_RAD_S, turn))
        self.wheels.publish(command)


def main() -> None:
    """Run the node until Ctrl-C."""
    try:
        rclpy.init()
        rclpy.spin(WallFollower())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
