"""The commands that record topics in a bag and play a bag."""

from __future__ import annotations

import argparse
import signal
import sys
from collections.abc import Sequence
from datetime import datetime
from pathlib import Path

import rclpy
from rclpy.executors import ExternalShutdownException

from thymio_sim_ros.bags.errors import BagError
from thymio_sim_ros.bags.player import Player
from thymio_sim_ros.bags.recorder import Recorder
from thymio_sim_ros.end_signals import END_SIGNALS

__all__ = ["run"]

_FAILED = 2


def run(options: argparse.Namespace, ros_arguments: Sequence[str]) -> int:
    """Run `options.command`, `record` or `play`; return the exit code."""
    rclpy.init(args=list(ros_arguments))
    try:
        if options.command == "record":
            return _record(options)
        return _play(options)
    except BagError as error:
        print(f"thymio-sim {options.command}: {error}", file=sys.stderr)
        return _FAILED
    except (KeyboardInterrupt, ExternalShutdownException):
        return 0
    finally:
        rclpy.try_shutdown()


def _record(options: argparse.Namespace) -> int:
    path = options.output or Path(f"rosbag2_{datetime.now().astimezone():%Y_%m_%d-%H_%M_%S}")
    node = rclpy.create_node("recorder")
    recorder = Recorder(
        node, path, storage=options.storage, topics=options.topics, includes_hidden=options.include_hidden
    )
    try:
        print(f"Recording to {path}. Ctrl-C ends the recording.", flush=True)
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        for one in END_SIGNALS:  # a second Ctrl-C must not leave a bag without its index
            signal.signal(one, signal.SIG_IGN)
        recorder.close()
        print(f"Recorded {recorder.count} messages of {len(recorder.topics)} topics to {path}.", flush=True)
    return 0


def _play(options: argparse.Namespace) -> int:
    with Player(rclpy.create_node("player"), options.bag, topics=options.topics) as player:
        if not player.topics:
            raise BagError(f"{options.bag}: found no topic of a known type, expected at least one")
        print(f"Playing {len(player.topics)} topics of {options.bag}.", flush=True)
        count = player.play(options.rate, options.delay)
    print(f"Played {count} messages.", flush=True)
    return 0
