"""Our own simulator, unchanged, on the embedded graph."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests.patience import PATIENCE_S
from tests.syntax import ROOT

DRIVE = Path(__file__).with_name("drive.py")
COMMAND = (sys.executable, "-m", "thymio_sim_ros.portable_ros")

pytestmark = pytest.mark.process


def test_a_node_drives_the_robot_of_the_simulator() -> None:
    command = [*COMMAND, str(DRIVE)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT, timeout=PATIENCE_S)
    assert done.returncode == 0, done.stderr
    seen = json.loads(done.stdout)
    assert seen["has driven"]
    assert seen["paused"]
    assert seen["reset"]
    assert "seed" in seen["refused"]
    assert {"base_link", "odom"} <= set(seen["frames"])
    assert "driver" in seen["logs"]
    assert {"/odom", "/tf", "/clock", "/cmd_vel", "/parameter_events"} <= set(seen["topics"])


def test_the_simulator_runs_alone_and_ends_at_ctrl_c() -> None:
    command = [*COMMAND, "-m", "thymio_sim_ros.ros.simulator.node"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, cwd=ROOT) as process:
        try:
            assert process.stderr is not None
            line = next((one for one in process.stderr if "Playground" in one), "")
            assert "[simulator]: Playground desk, robots in /" in line
            process.send_signal(signal.SIGINT)
            assert process.wait(PATIENCE_S) == 0
        finally:
            process.kill()
