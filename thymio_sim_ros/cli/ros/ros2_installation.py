"""The installation of the tools of ROS 2: pure Python, but no wheels, so they are built from the sources of Jazzy."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from collections.abc import Iterator, Sequence
from urllib.request import Request, urlopen

__all__ = ["COMMANDS", "INSTEAD", "install", "is_complete"]

_GITHUB = "https://github.com"
_COMMON = "ros2cli"
COMMANDS = ("action", "interface", "launch", "node", "param", "pkg", "run", "service", "topic")
"""The commands of `ros2` that are installed."""
_SOURCES = {
    "ament/ament_lint/archive/refs/tags/0.17.1": ("ament_copyright",),
    "ros2/launch/archive/refs/tags/3.4.3": ("launch", "launch_xml", "launch_yaml"),
    "ros2/launch_ros/archive/refs/tags/0.26.6": ("launch_ros", "ros2launch"),
    "ros2/ros2cli/archive/refs/tags/0.32.2": (_COMMON, *(f"ros2{one}" for one in COMMANDS if one != "launch")),
    "ros2/rosidl_runtime_py/archive/refs/tags/0.13.1": ("",),
}
"""Folders of packages by the archive that has them; "" is the archive itself."""
_DEPENDENCIES = (
    "argcomplete",
    "catkin_pkg",
    "distlib; sys_platform == 'win32'",  # programs of packages
    "empy<4",  # ros2pkg of Jazzy uses names that 4 does not have
    "importlib_metadata",
    "lark",
    "osrf_pycommon",
    "packaging",
    "psutil",
    "setuptools",
)
_MODULES = (_COMMON, *(f"ros2{one}" for one in COMMANDS), "launch_ros", "launch_xml", "launch_yaml")
_PATIENCE_S = 10.0
_ERROR = "ERROR: "
INSTEAD = "without it, use `thymio-sim topic`, `node`, `service`, `param`, `action` and `interface`"
_FAILED = 1


def is_complete() -> bool:
    """Whether all tools are installed."""
    return all(importlib.util.find_spec(name) is not None for name in _MODULES)


def install() -> int:
    """Install the tools into this Python; return the exit code. A failure is one line on stderr."""
    reason = (
        _unreachable(_GITHUB) or _install_packages(_DEPENDENCIES) or _install_packages(("--no-deps", *_requirements()))
    )
    if reason:
        print(f"thymio-sim ros2: cannot be installed: {reason}; {INSTEAD}", file=sys.stderr)
    return _FAILED if reason else 0


def _requirements() -> Iterator[str]:
    for archive, folders in _SOURCES.items():
        for folder in folders:
            name = folder or archive.split("/")[1]
            yield f"{name} @ {_GITHUB}/{archive}.tar.gz" + (f"#subdirectory={folder}" if folder else "")


def _unreachable(url: str) -> str:
    """Why an address cannot be reached; empty if it can. pip would try for minutes."""
    try:
        with urlopen(Request(url, method="HEAD"), timeout=_PATIENCE_S):
            return ""
    except OSError as error:
        return f"{url} cannot be reached ({getattr(error, 'reason', error)})"


def _install_packages(words: Sequence[str]) -> str:
    """Install packages by pip; return why that failed, otherwise nothing."""
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    done = subprocess.run([*pip, *words], capture_output=True, text=True, check=False)
    if not done.returncode:
        return ""
    reasons = [line for line in done.stderr.splitlines() if line.startswith(_ERROR)] or [done.stderr.strip()]
    return reasons[-1].removeprefix(_ERROR)
