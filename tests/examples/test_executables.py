"""Every example starts as an executable, without a simulator, and ends cleanly on Ctrl-C."""

from __future__ import annotations

import contextlib
import signal
import subprocess
import sys
from pathlib import Path

import pytest

import thymio_sim_ros.examples
from tests.patience import PATIENCE_S
from tests.processes import is_spinning, wait_until_asleep

NAMES = sorted(path.stem for path in Path(thymio_sim_ros.examples.__file__).parent.glob("[a-z]*.py"))


@pytest.mark.process
def test_every_example_ends_without_a_word_on_ctrl_c(ros):
    """All at the same time: most of the cost is the import of rclpy.

    One that does not end is aborted, and the failure shows where its threads are.
    """
    running = {}
    with contextlib.ExitStack() as stack:
        for name in NAMES:
            code = f"import sys; from thymio_sim_ros.entry_points import {name}; sys.exit({name}())"
            command = [sys.executable, "-X", "faulthandler", "-c", code, "--ros-args", "-p", "use_sim_time:=true"]
            process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            running[name] = stack.enter_context(process)
            stack.callback(process.kill)
        for name in NAMES:  # an interrupt while rclpy makes a node is an RCLError, or blocks it
            ros.until(is_spinning(ros, name), PATIENCE_S, what=f"the node {name}")
        for process in running.values():
            wait_until_asleep(process.pid)
            process.send_signal(signal.SIGINT)
        assert {name: _end(process) for name, process in running.items()} == dict.fromkeys(NAMES, ("", 0))


def _end(process: subprocess.Popen[str]) -> tuple[str, int]:
    """What a process printed until its end, and its exit code."""
    try:
        output, _ = process.communicate(timeout=PATIENCE_S)
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGABRT)
        output, _ = process.communicate(timeout=PATIENCE_S)
    return output, process.returncode
