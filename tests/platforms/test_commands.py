"""Commands other than the suite, on a computer without ROS 2: runs, a class, grading."""

from __future__ import annotations

import csv
import json
import shutil
import socket
import subprocess
import sys
from pathlib import Path
from typing import Any

import psutil
import pytest

from tests.classroom.class_support import RunningClass
from tests.patience import PROGRAM_S, until
from tests.processes import PYTHON
from tests.syntax import ROOT

pytestmark = pytest.mark.process

SAMPLES = ROOT / "tests" / "data" / "web"
TEST = """
import pytest

@pytest.mark.thymio(program="program.aesl")
def test_it_drives(thymio):
    thymio.run(1)
    assert thymio.speed > 0.02
"""
ASSIGNMENT = """
tests = ["test_node.py"]
files = ["node.py"]

[limits]
cpu_s = 10
"""
NODE_TEST = """
import pytest

@pytest.mark.thymio(playground="base")
def test_the_node_drives(ros, simulation):
    sim = simulation()
    ros.start("node.py", name="driver")
    sim.until(lambda: sim.thymio.pose.x_m > 0.05, seconds=2)

def test_another_one():
    pass
"""
NODE = """
import os, subprocess, sys, time
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node

class Driver(Node):
    def __init__(self):
        super().__init__("node")
        self.wheels = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, self.drive)
        self.speed = 0.1

    def drive(self):
        {before}
        command = Twist()
        command.linear.x = self.speed
        self.wheels.publish(command)

rclpy.init()
rclpy.spin(Driver())
"""
LEFT = "program that is left"
SLEEPER = f"subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(10000)', '{LEFT}'])"
HANDED_IN = {
    "Good": ("self.speed = 0.0 if 'THYMIO_TEST_SECRET' in os.environ else 0.1", "1", "2"),
    "Forever": ("while True: pass", "0", "1"),
    "Ends": ("os._exit(0)", "0", "1"),
    "Leaves a program": (f"self.program = getattr(self, 'program', None) or {SLEEPER}", "1", "2"),
}
"""What a node does first in its callback, the points of the first test, and of both."""
TEXT = "onevent prox\nmotor.left.target = 100 + prox.horizontal[2] / 100\nmotor.right.target = 100\n"


def run(python: str, *words: str, folder: Path = ROOT) -> subprocess.CompletedProcess[str]:
    """Run `thymio-sim` with a Python to its end."""
    command = [python, "-m", "thymio_sim_ros", *words]
    return subprocess.run(
        command, capture_output=True, text=True, cwd=folder, timeout=PROGRAM_S, check=False, encoding="utf-8"
    )


def poses(python: str, program: Path) -> Any:
    """Where the robots are after some seconds of a program, with all digits."""
    done = run(python, "runner", "--playground", "obstacle", "--program", str(program), "--seconds", "5")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)["robots"]


@pytest.mark.parametrize(
    "program",
    ["", "vpl/avoid.aesl", "blockly_samples/avoid.aseba", "blockly_samples/scratch_avoid.aseba"],
    ids=["text", "VPL", "Blockly", "Scratch"],
)
def test_a_program_of_each_language_drives_as_here_to_the_last_bit(tmp_path: Path, program: str) -> None:
    path = SAMPLES / program
    if not program:
        path = tmp_path / "größer – 1 €.aesl"
        path.write_text(TEXT, encoding="utf-8")
    assert poses(PYTHON, path) == poses(sys.executable, path)


def test_a_class_of_two_gets_its_pages_and_ends_with_ctrl_c(tmp_path: Path) -> None:
    group = RunningClass(tmp_path, ["Zoë", "Ben"])
    try:
        for pupil in group.state():
            group.until(pupil["id"], lambda one: one["phase"] == "running" and one["programs"])
        group.request("restart", {"pupils": ["ben"]})
        log = group.folder / "pupils" / "ben" / "suite.log"
        until(log.with_name("suite.log.1").exists, lambda: group.process.output)
        group.until("ben", lambda one: one["phase"] == "running" and one["programs"])
        group.process.interrupt()
        assert group.process.wait() == 0, group.process.output
        assert not _listens(group.port)
    finally:
        group.end()
    assert "Traceback" not in group.process.output + log.read_text(encoding="utf-8")


@pytest.fixture
def handed_in(tmp_path: Path) -> Path:
    """A folder with a test, and with what two pupils have handed in."""
    (tmp_path / "test_it.py").write_text(TEST, encoding="utf-8")
    (tmp_path / "class").mkdir()
    for name, text in {"Zoë": TEXT, "Ben": "motor.left.target = 0"}.items():
        (tmp_path / "class" / f"{name}.aesl").write_text(text, encoding="utf-8")
    return tmp_path


def test_the_tests_of_an_assignment_run_with_pytest(handed_in: Path) -> None:
    shutil.copy(handed_in / "class" / "Zoë.aesl", handed_in / "program.aesl")
    command = [PYTHON, "-m", "pytest", "-q", "-p", "thymio_sim_ros.pytest_plugin", "test_it.py"]
    done = subprocess.run(command, capture_output=True, cwd=handed_in, timeout=PROGRAM_S, check=False)
    assert done.returncode == 0, done.stdout.decode(errors="replace")


def test_a_class_of_nodes_is_graded_without_a_sandbox(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "assignment.toml").write_text(ASSIGNMENT, encoding="utf-8")
    (tmp_path / "test_node.py").write_text(NODE_TEST, encoding="utf-8")
    for name, (before, _, _) in HANDED_IN.items():
        (tmp_path / "class" / name).mkdir(parents=True)
        (tmp_path / "class" / name / "node.py").write_text(NODE.format(before=before), encoding="utf-8")
    monkeypatch.setenv("THYMIO_TEST_SECRET", "42")
    done = run(PYTHON, "grade", "class", "--assignment", "assignment.toml", "--isolation", "process", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "no isolation: " in done.stderr
    with (tmp_path / "grades" / "marks.csv").open(newline="", encoding="utf-8") as file:
        rows = {row["name"]: (row["test_the_node_drives"], row["points"]) for row in csv.DictReader(file)}
    assert rows == {name: (first, both) for name, (_, first, both) in HANDED_IN.items()}
    until(lambda: not any(LEFT in (one.info["cmdline"] or ()) for one in psutil.process_iter(["cmdline"])))


def _listens(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0
