"""Clients of other projects that use a robot by rosbridge: roslibpy, in Python, and roslib, in JavaScript.

roslib is needed in the folder that `THYMIO_SIM_NODE_MODULES` names, or in `web_ui/node_modules` (docs/testing.md).
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from importlib.machinery import PathFinder
from pathlib import Path

import pytest

from tests.patience import PATIENCE_S
from tests.processes import Process, free_port, wait_for_port

pytestmark = pytest.mark.process

DATA = Path(__file__).parents[1] / "data" / "rosbridge"
PLACES = (os.environ.get("THYMIO_SIM_NODE_MODULES", ""), str(Path(__file__).parents[2] / "web_ui" / "node_modules"))


needs_ros = pytest.mark.skipif(PathFinder.find_spec("rclpy") is None, reason="ROS 2 is not installed")


@pytest.fixture(params=["--portable", pytest.param("--ros", marks=needs_ros)])
def port(request, ros_domain, tmp_path):
    """The port of the bridge of a suite, on each graph; the robot stands in the middle of a large playground."""
    bridge_port = free_port()
    arguments = (request.param, "--port", str(free_port()), "--foxglove-port", str(bridge_port), "--program", "none")
    servers = ("--no-aseba", "--no-tdm", "--no-announcement", "--playground", "borderless")
    suite = Process(tmp_path, "thymio_sim_ros.cli.main", *arguments, *servers)
    wait_for_port(bridge_port)
    yield bridge_port
    suite.end()


def _said(command: list[str], port: int, **environment: str) -> dict[str, object]:
    """What a client printed, one JSON object per line, as one object."""
    url = f"ws://127.0.0.1:{port}"
    done = subprocess.run(
        command,
        env={**os.environ, "BRIDGE_URL": url, **environment},
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        check=False,
    )
    lines = [json.loads(line[1:]) for line in done.stdout.splitlines() if line.startswith("#")]
    assert done.returncode == 0, done.stdout + done.stderr
    return {key: value for line in lines for key, value in line.items()}


EXPECTED = {
    "topic type": "nav_msgs/msg/Odometry",
    "has node": True,
    "has moved": True,
    "parameter": "borderless",
    "answer": {"success": True, "message": "from the client"},
    "refused": "call_service.args: no field flag; fields are data",
}


def test_roslibpy_drives_a_robot_and_serves(port):
    assert _said([sys.executable, str(DATA / "use_robot.py")], port) == EXPECTED


@pytest.mark.skipif(shutil.which("node") is None, reason="Node is not installed")
def test_roslib_drives_a_robot_and_serves(port, tmp_path):
    modules = next((Path(place) for place in PLACES if place and (Path(place) / "roslib").is_dir()), None)
    if modules is None:
        pytest.skip("the npm package roslib is not installed (THYMIO_SIM_NODE_MODULES)")
    shutil.copy(DATA / "use_robot.mjs", tmp_path)
    (tmp_path / "node_modules").symlink_to(modules)  # modules are searched beside the file
    assert _said(["node", str(tmp_path / "use_robot.mjs")], port) == EXPECTED
