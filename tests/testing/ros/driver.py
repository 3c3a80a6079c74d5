"""A node that drives the robot by 0.1 m/s, in a file `driver.py`, and its test."""

from __future__ import annotations

__all__ = ["NODE", "TEST"]

NODE = """
from geometry_msgs.msg import Twist
from rclpy.node import Node

class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.out = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, self.drive)

    def drive(self):
        command = Twist()
        command.linear.x = 0.1
        self.out.publish(command)
"""
TEST = """
def test_it_drives(ros, simulation):
    sim = simulation()
    ros.start("driver.py")
    sim.until(lambda: sim.thymio.pose.x_m > 0.02, seconds=1)
"""
