"""A node that drives until something is near."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import Range


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.ahead = float("inf")
        self.wheels = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Range, "proximity/center", self.see, 10)
        self.create_timer(0.1, self.drive)

    def see(self, seen):
        self.ahead = seen.range

    def drive(self):
        command = Twist()
        if self.ahead > 0.1:
            command.linear.x = 0.1
        self.wheels.publish(command)


def main():
    rclpy.init()
    try:
        rclpy.spin(Driver())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
