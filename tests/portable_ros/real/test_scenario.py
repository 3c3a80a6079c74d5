"""The scenarios on rclpy and on the embedded graph: a process each, and the same results."""

from __future__ import annotations

import json
import subprocess
import sys
from importlib.machinery import PathFinder
from pathlib import Path
from typing import Any

import pytest

from tests.patience import PATIENCE_S

FOLDER = Path(__file__).parent.parent
SCENARIOS = [
    "scenario.py",
    "scenario_details.py",
    "scenario_lifecycle.py",
    "scenario_refusals.py",
    "scenario_values.py",
]
if PathFinder.find_spec("test_msgs") is not None:  # a package that has actions
    SCENARIOS.append("scenario_actions.py")
HERE = ("-m", "thymio_sim_ros.portable_ros")


def _seen(*words: str) -> dict[str, Any]:
    command = [sys.executable, *words]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=PATIENCE_S)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)  # type: ignore[no-any-return]


@pytest.mark.process
@pytest.mark.parametrize("executor", ["single", "multi"])
@pytest.mark.parametrize("scenario", SCENARIOS)
def test_the_embedded_graph_does_what_rclpy_does(scenario: str, executor: str, ros_domain: object) -> None:
    file = str(FOLDER / scenario)
    real, ours = _seen(file, executor), _seen(*HERE, file, executor)
    assert ours.keys() == real.keys()
    for part, found in real.items():
        assert ours[part] == found, part
