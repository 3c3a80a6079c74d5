"""A node that follows a line, with a yellow light while it steers to the left."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import ColorRGBA, Float32


class Follower(Node):
    def __init__(self):
        super().__init__("follower")
        self.left = self.right = 0.0
        self.wheels = self.create_publisher(Twist, "cmd_vel", 10)
        self.light = self.create_publisher(ColorRGBA, "led/body/top", 10)
        self.create_subscription(Float32, "ground/left/reflectance", self.see_left, 10)
        self.create_subscription(Float32, "ground/right/reflectance", self.see_right, 10)
        self.create_timer(0.1, self.drive)

    def see_left(self, floor):
        self.left = floor.data

    def see_right(self, floor):
        self.right = floor.data

    def drive(self):
        command = Twist()
        command.linear.x = 0.06
        # lighter at the left: the line is at the right, and right is negative
        command.angular.z = 1.8 * (self.right - self.left)
        self.wheels.publish(command)
        yellow = 1.0 if command.angular.z > 0.2 else 0.0
        self.light.publish(ColorRGBA(r=yellow, g=yellow, a=1.0))


def main():
    rclpy.init()
    try:
        rclpy.spin(Follower())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
