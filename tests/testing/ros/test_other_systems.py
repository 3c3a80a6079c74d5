"""Tests of nodes where Python has what it has on Windows, as far as Linux shows it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.patience import PROGRAM_S
from tests.testing.ros.driver import NODE, TEST

pytestmark = pytest.mark.process

ROOT = Path(__file__).parents[3]
RUN = """
import sys
import pytest
from tests import other_system
other_system.MODULES -= {"rclpy", "rcl_interfaces", "std_msgs", "rosgraph_msgs"}
other_system.MISSING[other_system.signal] += ("SIGVTALRM", "setitimer", "pthread_kill")
other_system.MISSING[other_system.os] += ("sysconf", "register_at_fork")
other_system.remove()
sys.exit(pytest.main(["-q", "-p", "no:cacheprovider", "-p", "thymio_sim_ros.pytest_plugin", *sys.argv[1:]]))
"""


def test_a_node_is_tested_without_posix_and_without_an_installed_ros(tmp_path: Path) -> None:
    (tmp_path / "driver.py").write_text(NODE, encoding="utf-8")
    (tmp_path / "test_driver.py").write_text(TEST, encoding="utf-8")
    command = [sys.executable, "-c", RUN, str(tmp_path)]
    alone = os.environ | {"PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    done = subprocess.run(command, cwd=ROOT, env=alone, capture_output=True, text=True, timeout=PROGRAM_S, check=False)
    assert "1 passed" in done.stdout, done.stdout + done.stderr
