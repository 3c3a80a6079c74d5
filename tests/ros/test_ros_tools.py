"""`thymio-sim topic` and others on an installed ROS 2, beside a suite on it."""

from __future__ import annotations

import subprocess

import pytest

from tests.patience import PATIENCE_S
from tests.processes import PYTHON, Process, free_port

pytestmark = pytest.mark.process


@pytest.fixture
def suite(ros, tmp_path):
    words = ("--ros", "--no-web", "--playground", "line", "--program", "none", "--foxglove-port", str(free_port()))
    process = Process(tmp_path, "thymio_sim_ros.cli.main", *words)
    ros.until(lambda: ros.node.count_subscribers("/cmd_vel"), PATIENCE_S, what="the robot")
    yield process
    process.end()


def run(*words):
    command = [PYTHON, "-m", "thymio_sim_ros", *words, "--ros"]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=PATIENCE_S)


def test_commands_are_members_of_the_domain(suite):
    done = run("topic", "echo", "--once", "/odom", "--field", "child_frame_id")
    assert (done.returncode, done.stdout, done.stderr) == (0, "base_link\n---\n", "")
    done = run("param", "get", "/simulator", "playground")
    assert (done.stdout, done.stderr) == ("String value is: line\n", "")
    done = run("service", "call", "/simulator/pause", "std_srvs/srv/SetBool", "data: true")
    assert "SetBool_Response(success=True, message='paused')" in done.stdout
    done = run("topic", "info", "/odm")
    assert (done.returncode, done.stderr) == (1, "thymio-sim topic info: found no topic /odm; did you mean /odom?\n")
