"""What the official tutorials do, executed as text: commands, turtles by tf2, nodes, interfaces of one's own."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests import terminals
from tests.processes import PYTHON

pytest.importorskip("rclpy")
pytestmark = [
    pytest.mark.process,
    pytest.mark.slow,
    pytest.mark.skipif(shutil.which("setsid") is None, reason="the program setsid is not installed"),
]


@pytest.mark.parametrize("name", ["commands", "follow", "libraries", "interfaces"])
def test_the_tutorials_run_as_written(name: str, ros_domain: int, tmp_path: Path) -> None:
    text = Path(__file__).with_name(f"{name}.md").read_text(encoding="utf-8")
    with terminals.reader(tmp_path, ros_domain) as reader:
        reader.follow(text)


@pytest.mark.skipif(sys.executable != PYTHON, reason="another computer has no installed ROS (docs/platforms.md)")
def test_nodes_of_the_tutorials_run_as_written_on_an_installed_ros(ros_domain: int, tmp_path: Path) -> None:
    text = Path(__file__).with_name("libraries.md").read_text(encoding="utf-8")
    text = text.replace("--portable --like turtlesim", "--ros").replace("thymio-sim node ", "python ")
    if subprocess.run([sys.executable, "-c", "import example_interfaces.srv"], stderr=subprocess.DEVNULL).returncode:
        # not among the wheels
        before, _, rest = text.partition("## A service and a client")
        text = before + rest[rest.index("## Parameters") :]
    with terminals.reader(tmp_path, ros_domain) as reader:
        reader.follow(text)
