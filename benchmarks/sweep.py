"""Sweeps: short runs per second with one and two workers beside a plain loop in one process, and what the engine costs.

The runs are those of `thymio-sim sweep` with the explorer among obstacles. Each side executes the same runs, wall time,
including the start of its processes; with "one killed", a worker is killed in the middle. The tables of all sides are
compared byte by byte. "Groups" are empty tasks, each scheduled alone: what the scheduler and this process can do at
most. Needs Dask and pyarrow.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from benchmarks.lib.report import Goal, Report, Table
from tests.batch_runs.tasks import nothing, run_and_kill_once
from thymio_sim_ros.batch_runs.engine import run_all
from thymio_sim_ros.sweep.description import Description
from thymio_sim_ros.sweep.grid import Sweep
from thymio_sim_ros.sweep.run import Row, run_robots
from thymio_sim_ros.sweep.table import write_table

QUICK = {"runs": 12, "seconds": 0.2, "groups": 20}

LOOP, ONE, TWO, KILLED = "a loop", "1 worker", "2 workers", "2 workers, one killed"

Rows = dict[int, list[Row]]


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--runs", type=int, default=5000, help="runs of each side")
    parser.add_argument("--seconds", type=float, default=1.0, help="simulated seconds of a run")
    parser.add_argument("--groups", type=int, default=2000, help="empty tasks")


def timed(call: Callable[[], Any]) -> tuple[Any, float, float]:
    """Return the result of a call, its wall time and the processor time of this process, in s."""
    wall_s, cpu_s = time.perf_counter(), time.process_time()
    result = call()
    return result, time.perf_counter() - wall_s, time.process_time() - cpu_s


def loop(sweep: Sweep) -> Rows:
    """Execute all runs in this process."""
    return {number: run_robots(sweep, number) for number in range(len(sweep))}


def on_workers(function: Callable[[int], Any], tasks: int, **options: Any) -> dict[int, Any]:
    """Execute tasks with the engine."""
    return {number: found for some in run_all(function, range(tasks), **options) for number, found in some}


def measure(options: argparse.Namespace) -> Report:
    """Measure all sides, one after the other."""
    sweep = Description(seeds=tuple(range(options.runs)), seconds=options.seconds).sweep()
    with tempfile.TemporaryDirectory() as folder:
        killing = partial(run_and_kill_once, Path(folder) / "killed", sweep, options.runs // 2)
        ours = partial(run_robots, sweep)
        run_robots(sweep, 0)  # fills caches
        sides = {
            LOOP: timed(lambda: loop(sweep)),
            ONE: timed(lambda: on_workers(ours, len(sweep), workers=1)),
            TWO: timed(lambda: on_workers(ours, len(sweep), workers=2)),
            KILLED: timed(lambda: on_workers(killing, len(sweep), workers=2)),
        }
        written = {name: _written(Path(folder) / "table.csv", sweep, rows) for name, (rows, _, _) in sides.items()}
        _, parquet_s, _ = timed(lambda: write_table(Path(folder) / "table.parquet", sweep, sides[LOOP][0]))
        _, csv_s, _ = timed(lambda: write_table(Path(folder) / "table.csv", sweep, sides[LOOP][0]))
    _, start_s, _ = timed(lambda: on_workers(nothing, 1, workers=2))
    _, groups_s, _ = timed(lambda: on_workers(nothing, options.groups, workers=2, group_s=0.0))
    rates = {name: len(sweep) / wall_s for name, (_, wall_s, _) in sides.items()}
    rows = [
        [name, rates[name], rates[name] / rates[LOOP], None if name == LOOP else 100.0 * cpu_s / wall_s]
        for name, (_, wall_s, cpu_s) in sides.items()
    ]
    groups = options.groups / max(groups_s - start_s, 1e-9)
    costs = [
        ["start and end of a cluster with 2 workers, s", start_s],
        ["groups per second, empty tasks", groups],
        [f"writing a table of {len(sweep)} rows, CSV, s", csv_s],
        [f"writing a table of {len(sweep)} rows, Parquet, s", parquet_s],
    ]
    return Report(
        [
            Table(
                [
                    f"{len(sweep)} runs of {options.seconds:g} s",
                    "runs per second",
                    "to a loop, ×",
                    "scheduling, % of a core",
                ],
                rows,
            ),
            Table(["the engine", ""], costs),
        ],
        [
            Goal("short runs with 1 worker, to a loop", 0.9, rates[ONE] / rates[LOOP], "×", is_least=True),
            Goal("short runs with 2 workers, to a loop", 1.7, rates[TWO] / rates[LOOP], "×", is_least=True),
            Goal("groups per second, empty tasks", 100.0, groups, is_least=True),
            Goal("tables that differ from that of a loop", 0, sum(one != written[LOOP] for one in written.values())),
        ],
    )


def _written(path: Path, sweep: Sweep, rows: Rows) -> bytes:
    write_table(path, sweep, rows)
    return path.read_bytes()
