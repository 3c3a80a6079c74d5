"""Every example starts as an executable, without a simulator, and ends cleanly on Ctrl-C."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import pytest

import thymio_sim_ros.examples
from tests.patience import PATIENCE_S
from tests.processes import wait_until_asleep

NAMES = sorted(path.stem for path in Path(thymio_sim_ros.examples.__file__).parent.glob("[a-z]*.py"))


@pytest.mark.process
def test_every_example_ends_without_a_word_on_ctrl_c(ros):
    """All at the same time: most of the cost is the import of rclpy."""
    running = {}
    try:
        for name in NAMES:
            code = f"import sys; from thymio_sim_ros.entry_points import {name}; sys.exit({name}())"
            command = [sys.executable, "-c", code, "--ros-args", "-p", "use_sim_time:=true"]
            running[name] = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        ros.until(lambda: set(NAMES) <= set(ros.node.get_node_names()), timeout=PATIENCE_S)
        for process in running.values():
            wait_until_asleep(process.pid)
            process.send_signal(signal.SIGINT)
        ended = {
            name: (process.communicate(timeout=PATIENCE_S)[0], process.returncode) for name, process in running.items()
        }
        assert ended == dict.fromkeys(NAMES, ("", 0))
    finally:
        for process in running.values():
            process.kill()
            process.wait()
