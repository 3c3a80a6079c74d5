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
from rclpy.utilities import remove_ros_args

from thymio_sim_ros.bags.errors import BagError
from thymio_sim_ros.bags.player import Player
from thymio_sim_ros.bags.recorder import STORAGES, Recorder

__all__ = ["main"]

_FAILED = 2


def main(words: Sequence[str] | None = None) -> int:
    """Run `record` or `play` with words of a command line, by default of the process; return the exit code."""
    given = sys.argv[1:] if words is None else list(words)
    options = _parser().parse_args(remove_ros_args(["bags", *given])[1:])
    rclpy.init(args=given)
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


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="thymio-sim", allow_abbrev=False)
    commands = parser.add_subparsers(dest="command", required=True)
    record = commands.add_parser("record", help="record topics in a bag until Ctrl-C", allow_abbrev=False)
    record.add_argument("topics", nargs="*", metavar="TOPIC", help="topics; without one, all that are not hidden")
    record.add_argument("-o", "--output", type=Path, help="the folder of the bag; by default, its name is the time")
    record.add_argument("--storage", choices=list(STORAGES), default="mcap", help="the form of its file (mcap)")
    record.add_argument("--include-hidden", action="store_true", help="also record hidden topics")
    play = commands.add_parser("play", help="publish the messages of a bag", allow_abbrev=False)
    play.add_argument("bag", type=Path, help="the folder of the bag")
    play.add_argument("--topics", nargs="+", default=(), metavar="TOPIC", help="play only these topics")
    play.add_argument("--rate", type=_rate, default=1.0, help="a factor of the speed, above 0 (1)")
    play.add_argument("--delay", type=float, default=0.5, metavar="S", help="seconds before the first message (0.5)")
    return parser


def _rate(text: str) -> float:
    rate = float(text)
    if not 0.0 < rate < float("inf"):
        raise argparse.ArgumentTypeError(f"found {text}, expected a number above 0")
    return rate


def _record(options: argparse.Namespace) -> int:
    path = options.output or Path(f"rosbag2_{datetime.now().astimezone():%Y_%m_%d-%H_%M_%S}")
    node = rclpy.create_node("recorder")
    recorder = Recorder(
        node, path, storage=options.storage, topics=options.topics, includes_hidden=options.include_hidden
    )
    print(f"Recording to {path}. Ctrl-C ends the recording.", flush=True)
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # a second Ctrl-C must not leave a bag without its index
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
