"""The nodes that pages show, as programs: Ctrl-C ends each of them without a traceback."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests import pages, ros_graph
from tests.patience import PATIENCE_S
from tests.processes import is_spinning, wait_until_asleep
from thymio_sim_ros import examples

pytest.importorskip("rclpy")

PAGES = [Path("../README.md"), *(path.relative_to(pages.DOCS) for path in sorted(pages.DOCS.rglob("*.md")))]
CREATE3 = ros_graph.needs_package("irobot_create_msgs")
NODES = [
    pytest.param(block.text, id=f"{page}:{block.line}", marks=CREATE3 if "irobot_create_msgs" in block.text else ())
    for page in PAGES
    for block in pages.all_blocks(pages.read(page))
    if "rclpy.spin(" in block.text and block.language == "python"
]
EXAMPLES = [
    pytest.param(path.read_text(encoding="utf-8"), id=path.stem)
    for path in sorted(Path(examples.__file__).parent.glob("*.py"))
    if path.stem != "__init__"
]


def test_the_pages_show_nodes() -> None:
    assert len(NODES) >= 5
    assert len(EXAMPLES) >= 6


@pytest.mark.parametrize("source", NODES + EXAMPLES)
def test_a_node_leaves_the_end_to_rclpy(source: str) -> None:
    """On Ctrl-C rclpy's own thread shuts down; a `try_shutdown` beside it raises RCLError now and then."""
    assert "try_shutdown" not in source


@pytest.mark.process
@pytest.mark.parametrize("source", NODES)
def test_a_node_of_a_page_ends_cleanly_on_ctrl_c(ros: Any, tmp_path: Path, source: str) -> None:
    (name,) = re.findall(r'super\(\).__init__\("(\w+)"\)', source)
    (tmp_path / "node.py").write_text(source, encoding="utf-8")
    command = [sys.executable, "node.py"]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as node:
        try:
            ros.until(is_spinning(ros, name), PATIENCE_S, what=f"the node {name}")
            wait_until_asleep(node.pid)
            node.send_signal(signal.SIGINT)
            output, _ = node.communicate(timeout=PATIENCE_S)
        finally:
            node.kill()
    assert "Traceback" not in output, output
    assert node.returncode == 0, output
