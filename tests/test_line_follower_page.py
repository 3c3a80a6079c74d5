"""docs/tutorials/line-follower-to-ros.md is true: its commands run as written, and step 1 is the sample of blocks."""

from __future__ import annotations

import importlib.util
import shutil
from pathlib import Path

import pytest

from tests import pages, terminals

TEXT = pages.read("tutorials/line-follower-to-ros.md")
SAMPLE = pages.ROOT / "tests" / "data" / "web" / "blockly_samples" / "line.aseba"


def test_the_text_of_step_1_is_that_of_the_blocks() -> None:
    expected = SAMPLE.read_text(encoding="utf-8").rstrip().replace("\t", "    ") + "\n"
    assert pages.files(TEXT)["line_blocks.aseba"] == expected


@pytest.mark.process
@pytest.mark.slow
@pytest.mark.skipif(shutil.which("setsid") is None, reason="the program setsid is not installed")
@pytest.mark.skipif(importlib.util.find_spec("rclpy") is None, reason="needs ROS")
def test_the_commands_do_what_the_page_promises(tmp_path: Path, ros_domain: int) -> None:
    with terminals.reader(tmp_path, ros_domain) as reader:
        reader.follow(TEXT)
