"""Nodes as students write them against the topics of the Thymio's ROS driver; our own text, the same calls."""

from __future__ import annotations

import math

from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from sensor_msgs.msg import Range
from std_msgs.msg import Bool, ColorRGBA
from std_srvs.srv import Empty

SIDE_M = 0.2
FRONT = ("left", "center_left", "center", "center_right", "right")
REAR = ("rear_left", "rear_right")


class Square(Node):
    """Drives a square by its odometry, one command for each side and each corner, and says so with its light."""

    def __init__(self):
        super().__init__("square")
        self.wheels = self.create_publisher(Twist, "cmd_vel", 10)
        self.light = self.create_publisher(ColorRGBA, "led/body/top", 10)
        self.create_subscription(Odometry, "odom", self.on_odometry, 10)
        self.begin = None
        self.is_turning = False
        self.corners = 0
        self.is_done = False

    def on_odometry(self, message):
        """Where it is by its wheels."""
        x, y = message.pose.pose.position.x, message.pose.pose.position.y
        turn = message.pose.pose.orientation
        yaw = 2 * math.atan2(turn.z, turn.w)
        if self.begin is None:
            self.start((x, y, yaw))
        elif self.is_turning:
            if math.cos(yaw - self.begin[2] - math.pi / 2) > 0.999:
                self.is_turning = False
                self.corners += 1
                self.start((x, y, yaw))
        elif math.dist((x, y), self.begin[:2]) >= SIDE_M:
            self.is_turning = True
            self.begin = (x, y, yaw)
            self.send(0.0, 0.5)
            self.light.publish(ColorRGBA(r=1.0, a=1.0))

    def start(self, place):
        """The next side, if any is left."""
        self.begin = place
        self.is_done = self.corners == 4
        self.send(0.0 if self.is_done else 0.1, 0.0)
        self.light.publish(ColorRGBA(g=1.0, a=1.0))

    def send(self, linear, angular):
        """One command; it holds until the next."""
        command = Twist()
        command.linear.x, command.angular.z = linear, angular
        self.wheels.publish(command)


class Shy(Node):
    """Seven subscriptions, 60 Hz of commands; a range that is -1 means that nothing is seen, and is added up."""

    def __init__(self):
        super().__init__("shy")
        self.ranges = dict.fromkeys((*FRONT, *REAR), -1.0)
        self.pressed = []
        for name in self.ranges:
            self.create_subscription(
                Range, f"proximity/{name}", lambda message, name=name: self.ranges.update({name: message.range}), 10
            )
        self.create_subscription(Bool, "buttons/center", self.pressed.append, 10)
        self.wheels = self.create_publisher(Twist, "cmd_vel", 10)
        self.timer = self.create_timer(1 / 60, self.act)

    def act(self):
        """The fewer sensors see something, the faster."""
        free = -sum(self.ranges[name] for name in FRONT) / len(FRONT)
        command = Twist()
        command.linear.x = 0.1 * free if free > 0.85 else 0.0
        self.wheels.publish(command)


class Careful(Node):
    """Stops where a range is below a limit, as code that compares does, in a namespace given by absolute names."""

    def __init__(self):
        super().__init__("careful")
        self.ready = self.create_client(Empty, "/thymio0/is_ready")
        self.wheels = self.create_publisher(Twist, "/thymio0/cmd_vel", 1)
        self.create_subscription(Range, "/thymio0/proximity/center", self.look, 10)

    def look(self, seen):
        """A measurement between min_range and max_range is one; everything else is not."""
        is_near = seen.min_range <= seen.range <= seen.max_range and seen.range < 0.08
        command = Twist()
        command.linear.x = 0.0 if is_near else 0.1
        self.wheels.publish(command)
