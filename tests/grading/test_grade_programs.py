"""The command `thymio-sim grade` on programs for ROS that run as processes of their own."""

from __future__ import annotations

import csv
import os
from pathlib import Path

import pytest

from tests.grading import ros_class
from tests.grading.test_attacks import playground
from tests.grading.test_grade import level
from thymio_sim_ros.cli import main
from thymio_sim_ros.grading.sandbox.levels import LEVELS, why_unavailable
from thymio_sim_ros.grading.sandbox.readable import PACKAGE_FOLDER
from thymio_sim_ros.portable_ros import import_hook

__all__ = ["level"]

pytestmark = pytest.mark.process

ASSIGNMENT = """
tests = ["test_driver.py"]
files = ["driver.py"]
data = ["own.json"]
"""
TEST = """
import pytest

@pytest.mark.points(2)
@pytest.mark.thymio(playground="own.json")
def test_it_drives(ros, simulation):
    sim = simulation()
    program = ros.run("driver.py")
    sim.until(lambda: sim.thymio.pose.x_m > 0.1, seconds=3)
    assert program.output == "drives\\n"
"""
GOOD = """
import time
import rclpy
from geometry_msgs.msg import Twist
rclpy.init()
node = rclpy.create_node("driver")
publisher = node.create_publisher(Twist, "cmd_vel", 10)
print("drives")
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
NOISY = "while True: print('x' * 1_000_000)"
FAILS = """
print("printed before")
with open("full", "wb") as file:
    while True: file.write(bytes(10 ** 6))
"""
SOME = ("Many threads", "Fixed speed", "Misspelt", "Forever")
"""Pupils of the class of nodes, one for each kind of mark."""


def grade(folder: Path, submissions: dict[str, str], level: str, *options: str) -> Path:
    """Grade these programs; return the folder of the reports."""
    (folder / "assignment.toml").write_text(ASSIGNMENT)
    (folder / "test_driver.py").write_text(TEST)
    (folder / "own.json").write_text(playground("Own"))
    for name, text in submissions.items():
        (folder / "class" / name).mkdir(parents=True)
        (folder / "class" / name / "driver.py").write_text(text)
    words = ["grade", folder / "class", "--assignment", folder / "assignment.toml", "-o", folder / "grades"]
    assert main.main([*map(str, words), "--workers", "2", "--isolation", level, *options]) == 0
    return folder / "grades"


def points(output: Path) -> dict[str, str]:
    """The points of each program."""
    with (output / "marks.csv").open(newline="") as file:
        return {row["name"]: row["points"] for row in csv.DictReader(file)}


@pytest.mark.slow
def test_programs_are_graded_and_cannot_end_the_grader(tmp_path: Path, level: str) -> None:
    output = grade(tmp_path, {"Good": GOOD, "Hostile": HOSTILE, "Noisy": NOISY, "Fails": FAILS}, level)
    assert points(output) == {"Good": "2", "Hostile": "0", "Noisy": "0", "Fails": "0"}
    pages = {name: next(output.glob(f"pupils/{name}-*/index.html")).read_text() for name in ("Noisy", "Fails")}
    assert "the program printed more than 10 MB" in pages["Noisy"]
    assert "output limit" in pages["Noisy"]
    assert "the program wrote more than 64 MB" in pages["Fails"]
    assert "printed before" in pages["Fails"]
    assert all(
        folder not in "".join(pages.values())
        for folder in ("/grade", str(PACKAGE_FOLDER), os.path.dirname(os.__file__))
    )


@pytest.mark.parametrize("name", LEVELS)
def test_every_level_runs_programs(tmp_path: Path, name: str) -> None:
    if reason := why_unavailable(name):
        pytest.skip(f"{name}: {reason}")
    assert points(grade(tmp_path, {"Good": GOOD}, name)) == {"Good": "2"}


@pytest.mark.parametrize(
    "names", [pytest.param(SOME, id="some"), pytest.param(tuple(ros_class.CLASS), id="all", marks=pytest.mark.slow)]
)
def test_a_class_of_nodes_gets_its_points(tmp_path: Path, level: str, names: tuple[str, ...]) -> None:
    assert points(graded_class(tmp_path, level, names)) == {name: str(ros_class.CLASS[name][1]) for name in names}


@pytest.mark.slow
@pytest.mark.skipif(import_hook.is_served("rclpy"), reason="needs an installed ROS 2")
def test_a_class_gets_the_same_marks_each_time_and_on_both_graphs(tmp_path: Path, level: str) -> None:
    tables = [
        (graded_class(tmp_path / name, level, tuple(ros_class.CLASS), *options) / "marks.csv").read_bytes()
        for name, options in RUNS.items()
    ]
    assert tables == [tables[0]] * len(RUNS)


RUNS = {"first": (), "second": (), "installed": ("--ros",)}


def graded_class(folder: Path, level: str, names: tuple[str, ...], *options: str) -> Path:
    """Grade these pupils of the class of nodes; return the folder of the reports."""
    for name in names:
        (folder / "class" / name).mkdir(parents=True)
        (folder / "class" / name / "node.py").write_text(ros_class.CLASS[name][0])
    (folder / "assignment.toml").write_text(ros_class.ASSIGNMENT)
    (folder / "test_node.py").write_text(ros_class.TEST)
    words = ["grade", folder / "class", "--assignment", folder / "assignment.toml", "-o", folder / "grades"]
    assert main.main([*map(str, words), "--workers", "2", "--isolation", level, *options]) == 0
    return folder / "grades"
