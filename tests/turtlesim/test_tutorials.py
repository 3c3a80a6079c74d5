"""The official tutorials with a Thymio as turtle: their commands, and turtles that follow each other by tf2."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests import terminals

pytest.importorskip("rclpy")
pytestmark = [
    pytest.mark.process,
    pytest.mark.slow,
    pytest.mark.skipif(shutil.which("setsid") is None, reason="the program setsid is not installed"),
]


@pytest.mark.parametrize("name", ["commands", "follow"])
def test_the_tutorials_run_as_written(name: str, ros_domain: int, tmp_path: Path) -> None:
    text = Path(__file__).with_name(f"{name}.md").read_text(encoding="utf-8")
    with terminals.reader(tmp_path, ros_domain) as reader:
        reader.follow(text)
