"""What the README shows is true: its node drives the robot, its topics and options exist."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests.patience import PATIENCE_S, PROGRAM_S
from thymio_sim_ros.cli import runner, suite

pytest.importorskip("rclpy")

from tests import pages
from tests.processes import Process, wait_until_asleep

README = pages.read("../README.md")


def words_of(pattern):
    """`proximity/{left,right}` as its topics."""
    match = re.search(r"\{(.*?)\}", pattern)
    if match is None:
        return [pattern]
    return [pattern.replace(match[0], word) for word in match[1].split(",")]


def table():
    """(topic, type) of each row of the topic table, types of the first kind only."""
    rows = [line.split("|")[1:3] for line in README.splitlines() if line.startswith("| `")]
    topics = []
    for names, kinds in rows:
        for name in re.findall(r"`([^`]+)`", names):
            topics += [(topic, kinds) for topic in words_of(name)]
    return topics


def test_every_topic_of_the_table_is_in_the_graph(ros, simulation, runtime):
    sim = simulation(playground="line")
    runtime(path="line_follower")
    sim.step(1.2)
    graph = dict(ros.node.get_topic_names_and_types())
    for name, kinds in table():
        topic = name.replace("<event>", "line")
        if topic == "aseba/emit/line":
            topic = "aseba/emit/speed"
        found = graph.get(topic if topic.startswith("/") else f"/{topic}")
        assert found, f"{name} is not in the graph"
        if "_msgs" in kinds:
            assert found[0].rsplit("/", 1)[1] in kinds, f"{name}: {found[0]}"


@pytest.mark.process
def test_the_node_of_the_readme_drives_the_robot(ros, tmp_path):
    from nav_msgs.msg import Odometry

    source, _ = pages.blocks(README, "python")
    assert len([line for line in source.splitlines() if line.strip()]) <= 20  # of which five end it cleanly
    suite = Process(tmp_path, "thymio_sim_ros.cli.main", "--headless", "--playground", "obstacle", "--program", "none")
    wanderer = tmp_path / "wanderer.py"
    wanderer.write_text(source)
    odometry: list[Odometry] = []
    ros.node.create_subscription(Odometry, "/odom", odometry.append, 10)
    try:
        ros.until(lambda: odometry, PATIENCE_S, what="odometry")
        assert odometry[-1].pose.pose.position.x == 0.0
        with subprocess.Popen([sys.executable, str(wanderer)]) as node:
            try:
                ros.until(lambda: odometry[-1].pose.pose.position.x > 0.05, PATIENCE_S, what="a moving robot")
                wait_until_asleep(node.pid)
                node.send_signal(signal.SIGINT)
                assert node.wait(PATIENCE_S) == 0
            finally:
                node.kill()
    finally:
        suite.end()


@pytest.mark.process
def test_the_test_of_the_readme_passes(pytester, monkeypatch):
    node, test = pages.blocks(README, "python")
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[1]))
    pytester.makepyfile(wanderer=node, test_wanderer=test)
    assert len([line for line in test.splitlines() if line.strip()]) <= 10
    result = pytester.runpytest_subprocess("-p", "thymio_sim_ros.pytest_plugin", "test_wanderer.py", timeout=PROGRAM_S)
    result.assert_outcomes(passed=1)


def test_the_commands_of_the_readme_exist():
    shell = "\n".join(pages.blocks(README, "sh"))
    options = set(re.findall(r"(--[a-z-]+)", "\n".join(line for line in shell.splitlines() if "thymio-sim" in line)))
    known = suite._parser().format_help() + runner._parser().format_help()
    assert options <= set(re.findall(r"(--[a-z-]+)", known))
    makefile = (Path(__file__).parents[1] / "Makefile").read_text()
    for target in re.findall(r"make ([a-z-]+)", README):
        assert re.search(rf"^{target}:", makefile, re.MULTILINE), f"make {target}"


def test_files_the_readme_points_to_exist():
    for target in re.findall(r"\]\((?!http)([^)]+)\)", README):
        assert (Path(__file__).parents[1] / target).is_file(), target
