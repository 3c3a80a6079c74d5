"""The command thymio-sim env --stubs, which needs no ROS."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from tests.syntax import ROOT
from thymio_sim_ros.cli import main


@pytest.fixture(autouse=True)
def _in_own_folder(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))


NODE = """\
import rclpy
from mine.msg import Speed
from rclpy.node import Node
from tf2_ros import Buffer, BufferClient, TransformListener
from tf2_ros.static_transform_broadcaster import StaticTransformBroadcaster
from tf_transformations import euler_from_quaternion

node = Node("typed")
buffer = Buffer(node=node)
TransformListener(buffer, node)
BufferClient(node, "lookup").lookup_transform("map", "odom", node.get_clock().now()).header.frame_id
Speed(value=1.0)
Speed(value="fast")  # wrong
Buffer().nothing()  # wrong
"""


@pytest.mark.process
def test_stubs_check_the_types_of_a_node(tmp_path, capsys):
    pytest.importorskip("mypy", reason="mypy is installed by `make lint`")
    (tmp_path / "mine" / "msg").mkdir(parents=True)
    (tmp_path / "mine" / "msg" / "Speed.msg").write_text("float64 value\n")
    (tmp_path / "node.py").write_text(NODE)
    assert main.main(["env", "--stubs", "--package", "mine"]) == 0
    assert "The stubs are in typings" in capsys.readouterr().out
    words = [sys.executable, "-m", "mypy", "--no-error-summary", "--cache-dir", "cache", "node.py"]
    environment = {**os.environ, "MYPYPATH": os.pathsep.join(("typings", str(ROOT)))}
    done = subprocess.run(words, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    wrong = [number for number, line in enumerate(NODE.splitlines(), 1) if line.endswith("# wrong")]
    assert [int(line.split(":")[1]) for line in done.stdout.splitlines() if ": error:" in line] == wrong, done.stdout


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--package", "mine"], "found no --stubs"),
        (["--stubs", "--package", "nothing"], "found no nothing with definitions"),
        (["--stubs", "file"], "--stubs: "),
    ],
)
def test_what_is_wrong_with_stubs_is_said(tmp_path, capsys, words, said):
    (tmp_path / "file").touch()
    assert main.main(["env", *words]) == 2
    assert said in capsys.readouterr().err
