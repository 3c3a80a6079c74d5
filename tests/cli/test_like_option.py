"""`thymio-sim --like`: what is refused before anything starts, and what a profile loads."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tests import plugin_page
from tests.processes import SUITE, Process, free_port
from thymio_sim_ros.cli import suite
from thymio_sim_ros.cli.main import main


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (["--like", "turtelsim"], "--like: found no robot 'turtelsim', expected 'turtlesim'"),
        (["--like", "turtlesim", "--like", "turtlesim"], "--like: found turtlesim and turtlesim, expected one robot"),
        (["--like", "turtlesim", "--robot", "tcp:localhost:33333"], "--robot: found --like"),
        (["--like", "turtlesim", "--replay", "run.jsonl"], "--replay: found --like"),
    ],
)
def test_what_cannot_be_is_one_line(capsys: pytest.CaptureFixture[str], words: list[str], reason: str) -> None:
    assert main(words) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"thymio-sim: {reason}")
    assert said.count("\n") == 1


@pytest.mark.parametrize(
    ("words", "playground", "program"),
    [
        ([], "desk", "welcome"),
        (["--like", "turtlesim"], "turtlesim", "none"),
        (["--like", "turtlebot3"], "turtlebot3", "none"),
        (["--like", "create3"], "turtlebot3", "none"),
        (["--like", "turtlesim", "--playground", "base", "--program", "avoid"], "base", "avoid"),
    ],
)
def test_a_profile_has_a_playground_and_a_program_of_its_own(words: list[str], playground: str, program: str) -> None:
    chosen = suite._suite_config(suite._parser().parse_args(words))
    assert (chosen.playground, chosen.program) == (playground, program)


@pytest.mark.process
@pytest.mark.ros
@pytest.mark.parametrize("graph", ["--ros", "--portable"])
def test_a_profile_of_another_package_with_a_type_that_is_nowhere_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, graph: str, ros_domain: int
) -> None:
    files = plugin_page.files()
    rover = "thymio_extras/rover.py"
    files[rover] = files[rover].replace("std_msgs/msg/Float64", "std_msgs/msg/Flot64", 1)
    plugin_page.lay_out(tmp_path, files)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path), prepend=os.pathsep)
    options = ("--headless", "--no-foxglove-port", "--port", str(free_port()))
    suite = Process(tmp_path, SUITE, "--like", "rover", graph, *options, variables={"ROS_DOMAIN_ID": str(ros_domain)})
    try:
        assert suite.wait() == 2
    finally:
        suite.end()
    (said,) = [line for line in suite.output.splitlines() if not line.startswith("ROS ")]
    assert said.startswith(
        "thymio-sim: --like rover: found no type std_msgs/msg/Flot64, expected 'std_msgs/msg/Float64' (one of"
    )
