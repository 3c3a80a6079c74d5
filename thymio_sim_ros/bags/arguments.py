"""The arguments of `thymio-sim record` and `thymio-sim play`."""

from __future__ import annotations

import argparse
from pathlib import Path

__all__ = ["STORAGES", "add_play_arguments", "add_record_arguments"]

STORAGES = ("mcap", "sqlite3")


def add_record_arguments(parser: argparse.ArgumentParser) -> None:
    """Add what is recorded, and where."""
    parser.add_argument("topics", nargs="*", metavar="TOPIC", help="topics; without one, all that are not hidden")
    parser.add_argument("-o", "--output", type=Path, help="the folder of the bag; by default, its name is the time")
    parser.add_argument("--storage", choices=STORAGES, default=STORAGES[0], help="the form of its file (mcap)")
    parser.add_argument("--include-hidden", action="store_true", help="also record hidden topics")


def add_play_arguments(parser: argparse.ArgumentParser) -> None:
    """Add what is played, and how fast."""
    parser.add_argument("bag", type=Path, help="the folder of the bag")
    parser.add_argument("--topics", nargs="+", default=(), metavar="TOPIC", help="play only these topics")
    parser.add_argument("--rate", type=_rate, default=1.0, help="a factor of the speed, above 0 (1)")
    parser.add_argument("--delay", type=float, default=0.5, metavar="S", help="seconds before the first message (0.5)")


def _rate(text: str) -> float:
    rate = float(text)
    if not 0.0 < rate < float("inf"):
        raise argparse.ArgumentTypeError(f"found {text}, expected a number above 0")
    return rate
