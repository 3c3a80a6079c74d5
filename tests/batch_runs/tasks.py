"""Tasks for worker processes."""

from __future__ import annotations

import os
import signal
from pathlib import Path

from thymio_sim_ros.sweep.grid import Sweep
from thymio_sim_ros.sweep.run import Row, run_robots

FATAL, WRONG = 7, 13


def kill_worker() -> None:
    """End this process as the kernel does when memory is short."""
    os.kill(os.getpid(), signal.SIGKILL)


def kill_worker_once(mark: Path) -> None:
    """End this process unless the file exists already."""
    try:
        mark.touch(exist_ok=False)
    except FileExistsError:
        return
    kill_worker()


def square(number: int) -> int:
    """The square, but some numbers are wrong and some are fatal."""
    if number == WRONG:
        raise ValueError(f"not {number},\nplease")
    if number == FATAL:
        kill_worker()
    return number * number


def nothing(number: int) -> None:
    """Do nothing."""


def run_and_kill_once(mark: Path, sweep: Sweep, fatal: int, number: int) -> list[Row]:
    """Execute a run; the worker of the run with the number `fatal` ends, once."""
    if number == fatal:
        kill_worker_once(mark)
    return run_robots(sweep, number)
