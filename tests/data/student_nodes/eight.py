"""Draws an eight: a full circle to the left, then one to the right, again and again."""

import math

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node


class Eight(Node):
    def __init__(self):
        super().__init__("eight")
        self.declare_parameter("radius", 0.08)
        self.declare_parameter("speed", 0.08)
        self.side = 1.0
        self.turned = 0.0
        self.last_yaw = None
        self.publisher_ = self.create_publisher(Twist, "cmd_vel", 10)
        self.subscription = self.create_subscription(Odometry, "odom", self.odom_callback, 10)
        self.timer = self.create_timer(0.05, self.timer_callback)

    def odom_callback(self, msg):
        q = msg.pose.pose.orientation
        yaw = math.atan2(2.0 * q.w * q.z, 1.0 - 2.0 * q.z * q.z)
        if self.last_yaw is not None:
            step = yaw - self.last_yaw
            self.turned += math.atan2(math.sin(step), math.cos(step))
        self.last_yaw = yaw
        if self.turned * self.side > 2.0 * math.pi:
            self.get_logger().info("other side")
            self.side, self.turned = -self.side, 0.0

    def timer_callback(self):
        speed = self.get_parameter("speed").get_parameter_value().double_value
        msg = Twist()
        msg.linear.x = speed
        msg.angular.z = self.side * speed / self.get_parameter("radius").value
        self.publisher_.publish(msg)


def main(args=None):
    rclpy.init(args=args)
    node = Eight()
    rclpy.spin(node)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
