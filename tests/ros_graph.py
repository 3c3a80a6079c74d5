"""The ROS graph of the nodes that tests make in their own process.

It is the embedded one (docs/portable-ros.md), which needs no discovery and no domain. One worker of several has that of
an installed ROS 2, for the tests that need one; `THYMIO_TEST_GRAPH=ros` chooses it for a whole run. Programs that tests
start choose for themselves.
"""

from __future__ import annotations

import functools
import importlib
import importlib.util
import os
from pathlib import Path
from typing import Any

import pytest

from thymio_sim_ros.portable_ros import import_hook

__all__ = ["IS_EMBEDDED", "ROS_WORKER", "module", "needs_package", "needs_ros"]

ROS_WORKER = "gw0"
"""The worker of pytest-xdist with an installed ROS 2."""
_ROOT = Path(__file__).parent
_REAL = (
    "cli/ros/test_env.py",
    "examples/test_executables.py",
    "grading/test_grade_programs.py",
    "lockstep/installed_ros",
    "portable_ros/real",
    "ros/aseba/outside/test_real_robot.py",
    "ros/aseba/test_real_robot_live.py",
    "ros/compat",
    "ros/simulator/test_clock_conflict.py",
    "ros/test_doctor.py",
    "ros/test_launch.py",
    "ros/test_namespace.py",
    "ros/test_processes.py",
    "ros/test_ros_tools.py",
    "ros/test_student_node.py",
    "ros/test_suite_process.py",
    "test_course.py",
    "test_course_packages.py",
    "test_entry_points.py",
    "test_errors.py",
    "test_example_nodes.py",
    "test_line_follower_page.py",
    "test_pytest_plugin.py",
    "test_readme.py",
    "test_tutorials.py",
    "tf/test_buffer_interface.py",
    "testing/ros/test_domain.py",
)
"""Folders and files of tests that need an installed ROS 2: its middleware, or nodes of other processes."""


@functools.cache
def needs_ros(path: Path | str) -> bool:
    """Whether the tests of a file need an installed ROS 2; the path is absolute, or one from the project's folder."""
    path = _ROOT.parent / path
    return any(_ROOT / name in (path, *path.parents) for name in _REAL)


def needs_package(name: str) -> pytest.MarkDecorator:
    """The mark of tests with types of a package that the embedded graph has, and an installed ROS 2 may not have."""
    return pytest.mark.skipif(importlib.util.find_spec(name) is None, reason=f"{name} is not in this ROS 2")


def module(name: str) -> Any:
    """A module that needs such a package. Where it cannot be imported, its names are empty classes.

    So each worker collects the same tests, as pytest-xdist demands; `needs_package` skips them.
    """
    try:
        return importlib.import_module(name)
    except ImportError:
        return _Missing()


class _Missing:
    def __getattr__(self, name: str) -> type:
        return type(name, (), {})


def _choose() -> bool:
    is_ros_worker = os.environ.get("PYTEST_XDIST_WORKER") == ROS_WORKER
    wanted = os.environ.get("THYMIO_TEST_GRAPH", "ros" if is_ros_worker else "embedded")
    return import_hook.install(is_forced=wanted != "ros")


IS_EMBEDDED = _choose()
"""Whether the nodes of this process are on the embedded graph."""
