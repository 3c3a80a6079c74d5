"""A class on this machine: CPU, memory and pace with so many pupils, while the teacher's page is open.

All robots drive. The teacher's page is a client that asks for the state twice per second, as the page does; no pupil's
page is open. "Server" is the process that supervises the suites. Memory is the proportional set size (PSS): what suites
share counts once. A pupil's suite keeps up if its real-time factor, over about the last second, is at least 0.95; the
figure is the part of all readings.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.lib.processes import cpu_s, pss_mb
from benchmarks.lib.report import Goal, Report, Table
from tests.classroom.class_support import RunningClass

QUICK = {"pupils": [2], "seconds": 2.0}
POLL_S = 0.5
KEEPS_UP = 0.95
LEAST_PERCENT = 95.0
"""Readings of twenty pupils that keep up."""
PUPILS = 30


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--pupils", type=int, nargs="+", default=[1, 10, 20, 30], help="numbers of pupils")
    parser.add_argument("--seconds", type=float, default=20.0, help="seconds of each measurement")
    parser.add_argument("--program", default="explorer", help="program of all robots")
    parser.add_argument("--ros", action="store_true", help="each robot in a ROS domain of its own")


def measure(options: argparse.Namespace) -> Report:
    """Measure a class of each size."""
    rows, goals = [], []
    for count in options.pupils:
        row, kept_up = one_class(
            count, options.seconds, ["--program", options.program, *(["--ros"] if options.ros else [])]
        )
        rows.append(row)
        if count == PUPILS:
            goals.append(Goal(f"{PUPILS} pupils in real time", LEAST_PERCENT, round(kept_up, 1), "%", is_least=True))
    columns = [
        *("pupils", "start, s", "a suite, % CPU", "server, % CPU", "all, % CPU", "a suite, MB", "real-time factor"),
        "keep up, %",
    ]
    return Report([Table(columns, rows)], goals)


def one_class(count: int, seconds: float, arguments: Sequence[str]) -> tuple[list[Any], float]:
    """Measure one class; return a row of the table and the percentage of readings that keep up."""
    names = [f"pupil {number}" for number in range(1, count + 1)]
    with tempfile.TemporaryDirectory() as folder:
        began_s = time.monotonic()
        running = RunningClass(Path(folder), names, arguments=tuple(arguments))
        try:
            for pupil in running.state():
                running.until(pupil["id"], lambda one: one["phase"] == "running" and one["programs"])
            start_s = time.monotonic() - began_s
            return _row(running, count, seconds, start_s)
        finally:
            running.end()


def _row(running: RunningClass, count: int, seconds: float, start_s: float) -> tuple[list[Any], float]:
    time.sleep(min(5.0, seconds))  # the factor is over the last second: the start is not part of it
    suites = [one.pid for one in running.suites()]
    processes = [running.process.pid, *suites]
    before = [cpu_s(pid) for pid in processes]
    begin_s = time.monotonic()
    factors: list[float] = []
    while time.monotonic() - begin_s < seconds:
        factors += [pupil["achieved"] for pupil in running.state()]
        time.sleep(POLL_S)
    passed_s = time.monotonic() - begin_s
    server, *shares = [100 * (cpu_s(pid) - old) / passed_s for pid, old in zip(processes, before, strict=True)]
    kept_up = 100 * sum(factor >= KEEPS_UP for factor in factors) / len(factors)
    memory = statistics.median(map(pss_mb, suites))
    row = [count, start_s, statistics.median(shares), server, server + sum(shares), memory]
    return [*row, statistics.median(factors), kept_up], kept_up
