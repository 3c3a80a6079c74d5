"""The scenario on rclpy and on the embedded graph: a process each, and the same results."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.patience import PATIENCE_S

SCENARIO = Path(__file__).parent.parent / "scenario.py"
HERE = ("-m", "thymio_sim_ros.portable_ros")


def _seen(*words: str) -> dict[str, Any]:
    command = [sys.executable, *words]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=PATIENCE_S)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)  # type: ignore[no-any-return]


@pytest.mark.process
@pytest.mark.parametrize("executor", ["single", "multi"])
def test_the_embedded_graph_does_what_rclpy_does(executor: str, ros_domain: object) -> None:
    real, ours = _seen(str(SCENARIO), executor), _seen(*HERE, str(SCENARIO), executor)
    assert ours.keys() == real.keys()
    for part, found in real.items():
        assert ours[part] == found, part
