"""A courier as a ROS node: follows the line, and stops in front of things."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import Range
from std_msgs.msg import Float32

TURN_RAD_S = 1.5
NEAR_M = 0.06


class Follower(Node):
    def __init__(self):
        super().__init__("follower")
        self.speed = self.declare_parameter("speed", 0.05).value
        self.left = self.right = 0.0
        self.is_blocked = False
        self.wheels = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Float32, "ground/left/reflectance", self.see_left, 10)
        self.create_subscription(Float32, "ground/right/reflectance", self.see_right, 10)
        self.create_subscription(Range, "proximity/center", self.see_ahead, 10)
        self.create_timer(0.1, self.drive)

    def see_left(self, floor):
        self.left = floor.data

    def see_right(self, floor):
        self.right = floor.data

    def see_ahead(self, seen):
        self.is_blocked = seen.range < NEAR_M

    def drive(self):
        command = Twist()
        if not self.is_blocked:
            command.linear.x = self.speed
            # lighter at the left: the line is at the right, and right is negative
            command.angular.z = TURN_RAD_S * (self.right - self.left)
        self.wheels.publish(command)


def main():
    rclpy.init()
    try:
        rclpy.spin(Follower())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()
