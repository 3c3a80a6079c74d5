"""Parts of commands with many tasks: options of the cluster, and progress on stderr.

The progress is one line that is rewritten on a terminal, otherwise a plain line now and then.
"""

from __future__ import annotations

import argparse
import sys
import time
from importlib.util import find_spec

from thymio_sim_ros.cli.errors import UsageError

__all__ = ["CLUSTER", "Progress", "add_cluster_options", "check_dask", "duration_text", "progress_text"]

CLUSTER = ("workers", "scheduler", "dashboard")
"""Names of the options of the cluster, as `batch_runs.engine.run_all` has them."""

TERMINAL_S, PLAIN_S = 0.2, 30.0
"""Time between two lines on a terminal, and elsewhere."""


def progress_text(noun: str, finished: int, total: int, failed: int, rate: float) -> str:
    """Finished and failed tasks, the rate, and the time left if the rate is known (above 0)."""
    parts = [f"{finished} of {total} {noun}"]
    if failed:
        parts.append(f"{failed} with errors")
    if rate > 0:
        parts += [
            f"{rate:.3g} per second" if rate >= 1 else f"{60 * rate:.3g} per minute",
            f"{duration_text((total - finished) / rate)} left",
        ]
    return ", ".join(parts)


def duration_text(seconds: float) -> str:
    """A duration in its two largest units, such as "2 h 5 min"."""
    whole = round(seconds)
    hours, minutes = divmod(whole // 60, 60)
    if hours:
        return f"{hours} h {minutes} min"
    return f"{minutes} min {whole % 60} s" if minutes else f"{whole} s"


class Progress:
    """Shows how many of the tasks, called by a plural noun, are finished. `resumed` tasks were finished before."""

    def __init__(self, noun: str, total: int, resumed: int) -> None:
        self._noun, self._total, self._resumed = noun, total, resumed
        self._is_terminal = sys.stderr.isatty()
        self._begun_s = self._shown_s = time.monotonic()

    def show(self, finished: int, failed: int) -> None:
        """Show the state, if the last line is old enough."""
        now_s = time.monotonic()
        if now_s - self._shown_s >= (TERMINAL_S if self._is_terminal else PLAIN_S):
            self._shown_s = now_s
            rate = (finished - self._resumed) / (now_s - self._begun_s)
            self._print(
                progress_text(self._noun, finished, self._total, failed, rate), end="" if self._is_terminal else "\n"
            )

    def end(self, finished: int, failed: int) -> None:
        """Show the final state."""
        self._print(progress_text(self._noun, finished, self._total, failed, 0.0), end="\n")

    def clear(self) -> None:
        """Make room for other output: take the line off the terminal until it is shown again."""
        if self._is_terminal:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)

    def _print(self, text: str, *, end: str) -> None:
        self.clear()
        print(f"thymio-sim: {text}", end=end, file=sys.stderr, flush=True)


def check_dask(extra: str) -> None:
    """Raise UsageError if Dask is not installed; `extra` is that of the command."""
    if find_spec("distributed") is None:
        raise UsageError(f"Dask is not installed; run `pip install 'thymio_sim_ros[{extra}]'`")


def add_cluster_options(parser: argparse.ArgumentParser) -> None:
    """Add the options that say where the tasks run."""
    cluster = parser.add_argument_group("where it runs")
    cluster.add_argument(
        "--workers", type=_workers_argument, metavar="N", help="processes on this machine (default: one per core)"
    )
    cluster.add_argument(
        "--scheduler", default="", metavar="ADDRESS", help="Dask scheduler of a cluster, such as tcp://10.0.0.1:8786"
    )
    cluster.add_argument(
        "--dashboard", default="", metavar="ADDRESS", help="Dask's dashboard for this machine, such as 127.0.0.1:8787"
    )


def _workers_argument(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"'{text}' found, expected a number of processes above 0")
    return int(text)
