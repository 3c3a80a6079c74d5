"""The process of a node that is written on the page: `thymio-sim node FILE` that waits for the begin of its program.

Usage: python -m thymio_sim_ros.cli.ros.page_node.program LINK URL FILE [ARGUMENT ...]

LINK is the number of an inherited socket that is connected with the server, or -1. A NUL byte on the standard output
says that all is ready; a line on the standard input begins the program.
"""

from __future__ import annotations

import importlib
import os
import socket
import sys

from thymio_sim_ros.access.tokens import TOKEN_VARIABLE
from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.cli.ros.node import prepare, run_connected

__all__ = ["READY", "main"]

READY = b"\0"
_INTERRUPTED = 130
_USUAL = ("rclpy.node", "rclpy.executors", "geometry_msgs.msg", "sensor_msgs.msg", "std_msgs.msg")


def main() -> int:
    """Run the program; return its exit code."""
    number, url, file, *arguments = sys.argv[1:]
    link = None if number == "-1" else socket.socket(fileno=int(number))
    token = os.environ.pop(TOKEN_VARIABLE, "")
    prepare()
    try:
        return run_connected(file, arguments, url=url, token=token, link=link, begin=_begin)
    except UsageError as error:
        print(error, file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return _INTERRUPTED


def _begin() -> None:
    """Import what most nodes import, and wait for the begin."""
    for name in _USUAL:
        importlib.import_module(name)
    os.write(1, READY)
    if not sys.stdin.buffer.readline():
        raise SystemExit(_INTERRUPTED)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.close(nothing)


if __name__ == "__main__":
    sys.exit(main())
