"""A node that drives, and stops in front of things with a red light."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import Range
from std_msgs.msg import ColorRGBA


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.ahead = float("inf")
        self.wheels = self.create_publisher(Twist, "cmd_vel", 10)
        self.light = self.create_publisher(ColorRGBA, "led/body/top", 10)
        self.create_subscription(Range, "proximity/center", self.see, 10)
        self.create_timer(0.1, self.drive)

    def see(self, seen):
        self.ahead = seen.range

    def drive(self):
        command, color = Twist(), ColorRGBA(a=1.0)
        if self.ahead > 0.06:
            command.linear.x = 0.1
        else:
            color.r = 1.0
        self.wheels.publish(command)
        self.light.publish(color)


def main():
    rclpy.init()
    try:
        rclpy.spin(Driver())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
