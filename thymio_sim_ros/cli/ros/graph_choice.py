"""Which ROS graph a command uses: that of an installed ROS 2, or the embedded one (docs/portable-ros.md)."""

from __future__ import annotations

import argparse
import importlib
import importlib.util
from collections.abc import Mapping

from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.names.domain import describe_domain
from thymio_sim_ros.portable_ros import import_hook

__all__ = ["add_graph_options", "check_ros", "choose_graph", "describe_graph"]

_ONLY_HERE = (
    "nodes of other programs see the robots by `thymio-sim node`; page, Foxglove and other servers work as always"
)

_WHERE_INSTALLED = "ROS 2 where it is installed, else the embedded graph"


def add_graph_options(parser: argparse.ArgumentParser, *, default: str = _WHERE_INSTALLED) -> None:
    """Add `--portable` and `--ros`, which exclude each other; `default` says what holds without both."""
    graphs = parser.add_mutually_exclusive_group()
    graphs.add_argument(
        "--portable",
        action="store_true",
        help="use the embedded ROS graph also where ROS 2 is installed: only nodes of this program and of "
        "`thymio-sim node` see the robots",
    )
    graphs.add_argument(
        "--ros",
        action="store_true",
        help=f"use an installed ROS 2 and nothing else (default: {default})",
    )


def choose_graph(*, portable: bool, ros: bool) -> bool:
    """Serve the embedded graph if there is no ROS 2, or with `portable`; return whether it is served.

    `ros` insists on an installed ROS 2. To be called before anything imports rclpy. Raises UsageError for a missing,
    incomplete or broken installation.
    """
    if ros:
        check_ros()
    elif _is_embedded(portable=portable):
        return True
    try:
        importlib.import_module("rclpy")
    except ImportError as error:
        raise UsageError(
            f"rclpy is installed, but cannot be imported: {error}; use the Python of your ROS 2 and source its setup "
            "file, or choose the embedded graph with --portable"
        ) from error
    return False


def describe_graph(environment: Mapping[str, str], *, is_embedded: bool) -> str:
    """One line: which graph this is, and who sees the robots on it."""
    if is_embedded:
        return f"ROS       embedded graph: {_ONLY_HERE}"
    return f"ROS       ROS 2, {describe_domain(environment)}: its nodes see the robots"


def check_ros() -> None:
    """Raise UsageError if ROS 2 is not installed."""
    if importlib.util.find_spec("rclpy") is None or import_hook.is_served("rclpy"):
        raise UsageError(
            "ROS 2 is not installed: on Linux x86-64 run `pip install 'thymio_sim_ros[ros]'`, elsewhere source a "
            "ROS 2 Jazzy installation; `thymio-sim` and `thymio-sim runner` work without ROS 2"
        )


def _is_embedded(*, portable: bool) -> bool:
    try:
        return import_hook.install(is_forced=portable)
    except import_hook.MixedInstallationError as error:
        raise UsageError(f"{error}; or choose --portable") from error
