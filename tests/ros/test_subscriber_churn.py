"""Listeners that come and go while playgrounds change do no harm."""

from __future__ import annotations

import subprocess
import sys

import pytest

from tests.patience import PROGRAM_S

CHANGES = 10
"""Changes of the playground during the storm."""
ROUNDS = 50
"""Rounds of the storm: 27 subscriptions each."""
STORM = f"""
import sys
import threading
import rclpy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Range
from std_msgs.msg import Int16MultiArray

rclpy.init()
node = rclpy.create_node("storm")
topics = [(Odometry, "odom"), (Int16MultiArray, "_raw/proximity"), (Range, "proximity/left")]
is_enough = threading.Event()
threading.Thread(target=lambda: (sys.stdin.read(), is_enough.set())).start()
print("begun", flush=True)
rounds = 0
while rounds < {ROUNDS} or not is_enough.is_set():
    heard = [
        node.create_subscription(kind, f"{{robot}}/{{topic}}", lambda message: None, 10)
        for robot in ("", "/red", "/blue")
        for kind, topic in topics
        for _ in range(3)
    ]
    for subscription in heard:
        node.destroy_subscription(subscription)
    rounds += 1
print("done")
"""


@pytest.mark.slow
def test_many_subscribers_survive_changes_of_the_playground(ros, simulation):
    sim = simulation(playground="two_robots")
    storm = subprocess.Popen(
        [sys.executable, "-X", "faulthandler", "-c", STORM],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    try:
        assert storm.stdout.readline() == "begun\n"
        for _ in range(CHANGES // 2):
            for name in ("line", "two_robots"):
                assert sim.simulator.parameter_callbacks.load_playground(name) == ""
                sim.step(0.05)
                ros.deliver()
        output, _ = storm.communicate(timeout=PROGRAM_S)  # closes its standard input, which ends the storm
    finally:
        storm.kill()
    assert (storm.returncode, output) == (0, "done\n")
