"""Commands other than the suite, on a computer without ROS 2: runs, a class, grading."""

from __future__ import annotations

import json
import shutil
import socket
import subprocess
import sys
from pathlib import Path
from typing import Any

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
NO_SANDBOX = (
    "thymio-sim: grading needs the sandboxes of Linux",
    "thymio-sim: this machine isolates no submissions (namespaces: ",
)
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


def test_grading_a_class_works_or_one_line_says_why_not(handed_in: Path) -> None:
    done = run(PYTHON, "grade", "class", "--assignment", "test_it.py", folder=handed_in)
    if done.returncode:
        (line,) = done.stderr.splitlines()
        assert line.startswith(NO_SANDBOX)
    else:
        assert "Zoë" in (handed_in / "grades" / "marks.csv").read_text(encoding="utf-8")


def _listens(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0
