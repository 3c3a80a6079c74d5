"""The command `thymio-sim ros2`: the tools of ROS 2 on the graph of a suite, and their installation."""

from __future__ import annotations

import argparse
import contextlib
import importlib.util
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from importlib import import_module
from typing import Any

from thymio_sim_ros import course_packages
from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.cli.ros import env, ros2_installation
from thymio_sim_ros.cli.ros.graph_choice import choose_graph
from thymio_sim_ros.cli.ros.interface_index import installed_interfaces
from thymio_sim_ros.cli.ros.membership import Membership, add_membership_options, interruptible, membership
from thymio_sim_ros.cli.ros.overlay import Overlay

__all__ = ["run"]

_FAILED = 1
_OF_PACKAGES = {"launch", "pkg", "run"}
"""Commands that work with packages, and so with those of the workspace."""
_OF_FILES = {"interface", "pkg"}
"""Commands that need no graph, and so no server."""
_OF_LAUNCH_ROS = "composition_interfaces"

_EPILOG = """\
  thymio-sim ros2 --install                installs them, from the sources of ROS 2 Jazzy on GitHub; once
  thymio-sim ros2 topic echo /odom
  thymio-sim ros2 --connect ws://teacher:8765 node list
  thymio-sim ros2 run my_package my_node   in the workspace, which need not be built
  thymio-sim ros2 launch my_package my.launch.py

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
    if options.install:
        return 0 if ros2_installation.is_complete() else ros2_installation.install()
    command = next(iter(options.words), "")
    for name in ("ros2cli", f"ros2{command}") if command in ros2_installation.COMMANDS else ("ros2cli",):
        if importlib.util.find_spec(name) is None:
            raise UsageError(
                f"ros2: found no {name}, expected it: `thymio-sim ros2 --install` installs it;"
                f" {ros2_installation.INSTEAD}"
            )
    with interruptible(), _membership(options, command) as member:
        sys.argv = ["ros2", *options.words]
        main: Callable[..., Any] = import_module("ros2cli.cli").main
        if not member.is_remote:
            if command == "launch" and importlib.util.find_spec(_OF_LAUNCH_ROS) is None:
                raise UsageError(
                    f"ros2 launch: found no {_OF_LAUNCH_ROS}, which launch_ros imports and no wheel has: use ROS 2 from"
                    " packages of the system, or the embedded graph: `thymio-sim --portable`"
                )
            os.environ.update(env.variables())
            code = main()
        elif command in _OF_PACKAGES and options.words[1:2] != ["create"]:
            code = _run_with_packages(main, options)
        else:
            with installed_interfaces() if command == "interface" else contextlib.nullcontext():
                code = main(extension=_WithoutDaemon())
    if isinstance(code, str):  # the reason of a failure
        print(code, file=sys.stderr)
        return _FAILED
    return int(code or 0)


@contextlib.contextmanager
def _membership(options: argparse.Namespace, command: str) -> Iterator[Membership]:
    """The membership that a command needs; that of `_OF_FILES` is not connected. Raises UsageError."""
    if command not in _OF_FILES:
        with membership(options, "ros2") as member:
            yield member
        return
    is_embedded = choose_graph(portable=bool(options.connect), ros=options.ros)
    course_packages.add_to_path()
    yield Membership("this computer", is_remote=is_embedded)


def _run_with_packages(main: Callable[..., Any], options: argparse.Namespace) -> Any:
    """Run a command with the packages of the workspace; return what `main` returns. Raises UsageError."""
    command, *words = options.words
    with Overlay.made(options) as overlay:
        if command == "run" and (reason := overlay.missing(words)):
            raise UsageError(f"ros2 run: {reason}")
        code = main(extension=_WithoutDaemon())
        if code and command == "launch" and (reason := overlay.not_in_python()):
            print(f"thymio-sim ros2 launch: {reason}", file=sys.stderr)
        return code


class _WithoutDaemon:
    """The command `ros2` as an extension of ros2cli: as its own, but each verb looks at the graph itself.

    The daemon of ros2cli is a process of its own, which is not a member of this graph.
    """

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        """Add all commands, as `ros2cli.cli` does."""
        hidden = ["extension_points", "extensions"]
        add: Callable[..., object] = import_module("ros2cli.command").add_subparsers_on_demand
        add(parser, cli_name, "_command", "ros2cli.command", hide_extensions=hidden, required=False)

    def main(self, *, parser: argparse.ArgumentParser, args: argparse.Namespace) -> object:
        """Run the chosen command as with `--no-daemon`; return its exit code, or the reason of a failure."""
        command = getattr(args, "_command", None)
        if command is None:
            parser.print_help()
            return 0
        args.no_daemon = True
        return command.main(parser=parser, args=args)
