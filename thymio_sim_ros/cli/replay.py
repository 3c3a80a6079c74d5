"""The command `thymio-sim replay`: repeat a run from its log and compare every tick."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import thymio_sim_ros
from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.cli.output import print_json
from thymio_sim_ros.engine.replay import replay
from thymio_sim_ros.engine.run_log import RunLogError, made_by

__all__ = ["DIFFERENT", "run"]

DIFFERENT = 1
"""Exit code for a run that differs from its log."""


def run(argv: Sequence[str]) -> int:
    """Replay a run log and print the result; return the exit code. Raises UsageError for a file that is no run log."""
    options = _parser().parse_args(argv)
    started = time.perf_counter()
    try:
        result = replay(options.file)
    except OSError as error:
        raise UsageError(f"{options.file}: {error.strerror}; expected a run log") from error
    except RunLogError as error:
        raise UsageError(str(error)) from error
    factor = result.seconds / max(time.perf_counter() - started, 1e-9)
    if not result.is_complete:
        _print_error(options.file, "the log is cut off; replayed up to its last complete line")
    if result.differs is not None:
        number, tick = result.differs
        maker, current = made_by(options.file), thymio_sim_ros.__version__
        versions = "" if maker == current else f" (log written by version {maker}, this is {current})"
        _print_error(options.file, f"run {number}, tick {tick} differs from the log{versions}")
    report = {"runs": result.runs, "seconds": result.seconds, "identical": result.differs is None}
    print_json(report | {"real_time_factor": round(factor, 1)})
    return 0 if result.differs is None else DIFFERENT


def _print_error(file: Path, text: str) -> None:
    print(f"thymio-sim: {file}: {text}", file=sys.stderr)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="thymio-sim replay",
        description="Repeat a run from its log and compare every tick bit for bit. Exit code 1: a tick differs.",
        allow_abbrev=False,
    )
    parser.add_argument("file", type=Path, metavar="FILE", help="a log of `thymio-sim runner --log` or the simulator")
    return parser
