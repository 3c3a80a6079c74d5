"""The choice of the ROS graph. Suites on both: tests/portable_ros/test_suite.py, tests/ros/test_processes.py."""

from __future__ import annotations

import importlib
from typing import NoReturn

import pytest

from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.cli.ros.graph_choice import choose_graph, describe_graph
from thymio_sim_ros.portable_ros import import_hook


def test_an_rclpy_that_cannot_be_imported_is_one_line_with_both_ways_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """As that of Jazzy, which is for Python 3.12, in another Python."""

    def fail(name: str) -> NoReturn:
        raise ImportError(f"no module named '{name}._rclpy_pybind11'")

    monkeypatch.setattr(import_hook, "install", lambda *, is_forced: is_forced)
    monkeypatch.setattr(importlib, "import_module", fail)
    with pytest.raises(UsageError, match=r"_rclpy_pybind11'; use the Python of your ROS 2 .* --portable"):
        choose_graph(portable=False, ros=False)
    assert choose_graph(portable=True, ros=False)


def test_half_an_installation_is_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*, is_forced: bool) -> NoReturn:
        raise import_hook.MixedInstallationError(f"found std_msgs without rclpy {is_forced}")

    monkeypatch.setattr(import_hook, "install", refuse)
    with pytest.raises(UsageError, match="found std_msgs without rclpy False; or choose --portable"):
        choose_graph(portable=False, ros=False)


def test_the_first_line_says_who_sees_the_robots() -> None:
    assert "nodes of other programs see the robots by `thymio-sim node`" in describe_graph(
        {"ROS_DOMAIN_ID": "7"}, is_embedded=True
    )
    line = describe_graph({"ROS_DOMAIN_ID": "7"}, is_embedded=False)
    assert line == "ROS       ROS 2, ROS_DOMAIN_ID 7, this network: its nodes see the robots"
