"""The command `thymio-sim ros2`: the tools of ROS 2 on the graph of a suite, and their installation."""

from __future__ import annotations

import argparse
import importlib.util
import subprocess
import sys
from collections.abc import Sequence
from importlib import import_module
from urllib.request import Request, urlopen

from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.cli.membership import add_membership_options, interruptible, membership

__all__ = ["run"]

_TOOLS = "https://github.com/ros2/ros2cli/archive/refs/tags/0.32.2.tar.gz"
_RUNTIME = "https://github.com/ros2/rosidl_runtime_py/archive/refs/tags/0.13.1.tar.gz"
"""The tools are no wheels, but pure Python, and are built from the sources of Jazzy."""
_PARTS = (
    "ros2cli",
    "ros2action",
    "ros2interface",
    "ros2node",
    "ros2param",
    "ros2pkg",
    "ros2run",
    "ros2service",
    "ros2topic",
)
_DEPENDENCIES = ("argcomplete", "importlib_metadata", "packaging", "psutil")
_PATIENCE_S = 10.0
_ERROR = "ERROR: "
_INSTEAD = "without it, use `thymio-sim topic`, `node`, `service`, `param`, `action` and `interface`"
_FAILED = 1

_EPILOG = """\
  thymio-sim ros2 --install                installs them, from the sources of ROS 2 Jazzy on GitHub; once
  thymio-sim ros2 topic echo /odom
  thymio-sim ros2 --connect ws://teacher:8765 node list

Where ROS 2 is installed, `ros2` itself does the same after `eval "$(thymio-sim env)"`.
"""


def run(argv: Sequence[str]) -> int:
    """Run `ros2` with the words, or install it; return the exit code. Raises UsageError."""
    parser = argparse.ArgumentParser(
        prog="thymio-sim ros2",
        description="Run the tools of ROS 2 on the graph of a suite, also without ROS 2.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("--install", action="store_true", help="install the tools into the Python of thymio-sim")
    add_membership_options(parser)
    parser.add_argument("words", nargs=argparse.REMAINDER, metavar="WORD", help="the command line of `ros2`")
    options = parser.parse_args(argv)
    is_installed = importlib.util.find_spec("ros2cli") is not None
    if options.install:
        return 0 if is_installed else _install()
    if not is_installed:
        raise UsageError(f"ros2: found no ros2cli, expected it: `thymio-sim ros2 --install` installs it; {_INSTEAD}")
    with interruptible(), membership(options, "ros2") as member:
        if member.is_remote:
            _use_no_daemon()
        sys.argv = ["ros2", *options.words]
        code = import_module("ros2cli.cli").main()
    if isinstance(code, str):  # the reason of a failure
        print(code, file=sys.stderr)
        return _FAILED
    return int(code or 0)


def _use_no_daemon() -> None:
    """Have the tools ask the graph of this process: their daemon is a process of its own, which is not on it."""
    strategy = import_module("ros2cli.node.strategy")
    for name in ("is_daemon_running", "spawn_daemon"):
        setattr(strategy, name, lambda *_words, **_options: False)


def _install() -> int:
    reason = _unreachable(_TOOLS) or _install_packages(_DEPENDENCIES) or _install_packages(("--no-deps", *_sources()))
    if reason:
        print(f"thymio-sim ros2: cannot be installed: {reason}; {_INSTEAD}", file=sys.stderr)
    return _FAILED if reason else 0


def _sources() -> list[str]:
    return [f"rosidl_runtime_py @ {_RUNTIME}", *(f"{part} @ {_TOOLS}#subdirectory={part}" for part in _PARTS)]


def _unreachable(url: str) -> str:
    """Why an address cannot be reached; empty if it can. pip would try for minutes."""
    try:
        with urlopen(Request(url, method="HEAD"), timeout=_PATIENCE_S):
            return ""
    except OSError as error:
        return f"{url.partition('/ros2/')[0]} cannot be reached ({getattr(error, 'reason', error)})"


def _install_packages(words: Sequence[str]) -> str:
    """Install packages by pip; return why that failed, otherwise nothing."""
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    done = subprocess.run([*pip, *words], capture_output=True, text=True, check=False)
    if not done.returncode:
        return ""
    reasons = [line for line in done.stderr.splitlines() if line.startswith(_ERROR)] or [done.stderr.strip()]
    return reasons[-1].removeprefix(_ERROR)
