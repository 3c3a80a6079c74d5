"""The turtle of a suite in place of the program `turtlesim_node`, for launch files that start that one.

The suite (`thymio-sim --like turtlesim`) simulates; this program waits until it is ended, so that a launch goes on.
"""

from __future__ import annotations

import sys

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from turtlesim.srv import Spawn

__all__ = ["main"]

_PATIENCE_S = 10.0
_FAILED = 1


def main() -> int:
    """Wait until Ctrl-C; return the exit code: 1 if there are no turtles in this namespace."""
    try:
        rclpy.init()
        node = Node("turtlesim_of_suite")
        client = node.create_client(Spawn, "spawn")
        if not client.wait_for_service(timeout_sec=_PATIENCE_S):
            print(
                f"turtlesim_node: found no turtles, since nothing serves {client.service_name}: start"
                " `thymio-sim --like turtlesim` first, which has one world without a namespace",
                file=sys.stderr,
            )
            return _FAILED
        node.get_logger().info("the turtles are those of `thymio-sim --like turtlesim`")
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
