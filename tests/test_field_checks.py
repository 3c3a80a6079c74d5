"""An int in a float field of a message is an error wherever tests run, with the line that set it."""

from __future__ import annotations

import pytest

pytest.importorskip("rclpy")

CONFTEST = "from geometry_msgs.msg import Twist\n"
NODE = """
from geometry_msgs.msg import Twist
from rclpy.node import Node

class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.out = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, self.drive)

    def drive(self):
        message = Twist()
        message.linear.x = 1
        self.out.publish(message)
"""
TEST = """
def test_it_drives(ros, simulation):
    sim = simulation()
    ros.start("driver.py")
    sim.until(lambda: sim.thymio.pose.x_m > 0.02, seconds=1)
"""


@pytest.mark.process
def test_a_node_under_test_is_checked_although_conftest_imports_the_messages(pytester, monkeypatch):
    monkeypatch.delenv("ROS_PYTHON_CHECK_FIELDS", raising=False)
    pytester.makeconftest(CONFTEST)
    pytester.makepyfile(driver=NODE, test_driver=TEST)
    result = pytester.runpytest_subprocess("-p", "no:cacheprovider")
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*message.linear.x = 1*", "*The 'x' field must be of type 'float'*"])
