"""The command `thymio-sim grade` on programs for ROS that run as processes of their own."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

pytest.importorskip("rclpy")

from tests.grading.test_grade import level
from thymio_sim_ros.cli import main

__all__ = ["level"]

pytestmark = pytest.mark.process

ASSIGNMENT = """
tests = ["test_driver.py"]
files = ["driver.py"]
"""
TEST = """
import pytest

@pytest.mark.points(2)
@pytest.mark.thymio(playground="base")
def test_it_drives(ros, simulation):
    sim = simulation()
    ros.run("driver.py")
    sim.until(lambda: sim.thymio.pose.x_m > 0.1, seconds=3)
"""
GOOD = """
import time
import rclpy
from geometry_msgs.msg import Twist
rclpy.init()
node = rclpy.create_node("driver")
publisher = node.create_publisher(Twist, "cmd_vel", 10)
while rclpy.ok():
    message = Twist()
    message.linear.x = 0.1
    publisher.publish(message)
    time.sleep(0.1)
"""
HOSTILE = """
import os, signal
for pid in (os.getppid(), *range(2, 100)):
    try:
        os.kill(pid, signal.SIGKILL)
    except OSError:
        pass
"""


def test_programs_are_graded_and_cannot_end_the_grader(tmp_path: Path, level: str) -> None:
    (tmp_path / "assignment.toml").write_text(ASSIGNMENT)
    (tmp_path / "test_driver.py").write_text(TEST)
    for name, text in {"Good": GOOD, "Hostile": HOSTILE, "Stands": GOOD.replace("= 0.1", "= 0.0")}.items():
        folder = tmp_path / "class" / name
        folder.mkdir(parents=True)
        (folder / "driver.py").write_text(text)
    output = tmp_path / "grades"
    words = ["grade", tmp_path / "class", "--assignment", tmp_path / "assignment.toml", "-o", output, "--workers", 3]
    assert main.main(list(map(str, words))) == 0
    with (output / "marks.csv").open(newline="") as file:
        points = {row["name"]: row["points"] for row in csv.DictReader(file)}
    assert points == {"Good": "2", "Hostile": "0", "Stands": "0"}
