"""Listeners that come and go while playgrounds change do no harm."""

from __future__ import annotations

import subprocess
import sys

STORM_S = 5
STORM = f"""
import time
import rclpy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Range
from std_msgs.msg import Int16MultiArray

rclpy.init()
node = rclpy.create_node("storm")
topics = [(Odometry, "odom"), (Int16MultiArray, "_raw/proximity"), (Range, "proximity/left")]
end = time.monotonic() + {STORM_S}
while time.monotonic() < end:
    heard = [
        node.create_subscription(kind, f"{{robot}}/{{topic}}", lambda message: None, 10)
        for robot in ("", "/red", "/blue")
        for kind, topic in topics
        for _ in range(3)
    ]
    for subscription in heard:
        node.destroy_subscription(subscription)
print("done")
"""


def test_many_subscribers_survive_changes_of_the_playground(ros, simulation):
    sim = simulation(playground="two_robots")
    storm = subprocess.Popen(
        [sys.executable, "-X", "faulthandler", "-c", STORM], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    changes = 0
    try:
        while storm.poll() is None:
            for name in ("line", "two_robots"):
                assert sim.simulator.parameter_callbacks.load_playground(name) == ""
                sim.step(0.05)
                ros.deliver()
                changes += 1
    finally:
        storm.kill()
    output = storm.communicate()[0]
    assert (storm.returncode, output) == (0, "done\n")
    assert changes > 2
