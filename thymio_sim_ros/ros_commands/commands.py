"""Runs a verb of a noun as a hidden node."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from importlib import import_module

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from thymio_sim_ros.ros_commands.errors import CommandError
from thymio_sim_ros.ros_commands.member import Member

__all__ = ["run"]

_FAILED = 1


def run(options: argparse.Namespace, ros_arguments: Sequence[str], discovery_s: float) -> int:
    """Run `options.verb` of `options.command` until it has ended or Ctrl-C; return the exit code.

    `discovery_s` is the longest wait for what is not there; 0 where the graph is known from the start.
    """
    rclpy.init(args=list(ros_arguments), signal_handler_options=SignalHandlerOptions.NO)
    try:
        name = f"_thymio_sim_{options.command}_{os.getpid()}"
        node = Node(name, enable_rosout=False, start_parameter_services=False)
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        import_module(f"{__package__}.{options.command}").VERBS[options.verb](
            Member(node, executor, discovery_s), options
        )
    except CommandError as error:
        print(f"thymio-sim {options.command} {options.verb}: {error}", file=sys.stderr)
        return _FAILED
    except KeyboardInterrupt:
        return 0
    finally:
        rclpy.try_shutdown()
    return 0
