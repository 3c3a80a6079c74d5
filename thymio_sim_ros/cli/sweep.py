"""The command `thymio-sim sweep`: many runs on all cores or on a cluster, with a table of results."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Sequence
from contextlib import closing
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from aseba_vm.cli.output import exit_by_signal
from thymio_sim_ros.batch_runs.errors import EngineError
from thymio_sim_ros.batch_runs.failure import Failure
from thymio_sim_ros.cli.batch import CLUSTER, Progress, add_cluster_options, check_dask
from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.cli.options import path_argument
from thymio_sim_ros.cli.output import print_json
from thymio_sim_ros.cli.signal_handling import StopSignal
from thymio_sim_ros.sweep import table
from thymio_sim_ros.sweep.description import Description, described, notes_of, read_description
from thymio_sim_ros.sweep.errors import SweepError
from thymio_sim_ros.sweep.grid import Sweep
from thymio_sim_ros.sweep.measures import MEASURES
from thymio_sim_ros.sweep.run import Row, failed_row, run_robots

__all__ = ["run"]

FAILED = 1

WRITE_S, WRITE_SHARE = 5.0, 0.05
"""The table is written at most every so many seconds, and in at most this part of the time."""

EPILOG = f"""\
A file has the same keys in TOML or JSON: programs, playgrounds, seeds, seconds, measures, limit_s, and a table of
parameters. Options replace what the file says. The same command continues an interrupted sweep.

measures: {", ".join(MEASURES)},
event.NAME (times it was emitted), first.NAME (when first, s), variable.NAME or variable.NAME[i] (at the end)

exit code: 0 done; 1 some runs have an error (column `error`); 2 rejected input, or a cluster that cannot be used

example:
  thymio-sim sweep --program explorer --seeds 100 --parameter CRUISE=100,150,200 -o cruise.csv
  thymio-sim sweep cruise.toml --scheduler tcp://10.0.0.1:8786 -o cruise.parquet
"""


def run(argv: Sequence[str]) -> int:
    """Run the sweep that the options describe; return the exit code. Raises UsageError for rejected input."""
    options = _parser().parse_args(argv)
    check_dask("sweep")
    try:
        sweep = _description(options).sweep()
        path = options.output or _default_output(options.file)
        table.check_suffix(path)
        for note in notes_of(sweep):
            print(f"thymio-sim: {note}", file=sys.stderr)
        finished = table.read_table(path, sweep)
        if options.repeat_errors:
            finished = {number: rows for number, rows in finished.items() if not _has_error(rows)}
        return _Execution(sweep, path, finished).run(options)
    except (SweepError, EngineError) as error:
        raise UsageError(str(error)) from error
    except OSError as error:
        raise UsageError(f"{error.filename or path}: {error.strerror}; expected a file that can be written") from error


def _has_error(rows: Sequence[Row]) -> bool:
    return any(row["error"] is not None for row in rows)


class _Execution:
    """The execution of a sweep. Invariant: `_rows` has the rows of all finished runs."""

    def __init__(self, sweep: Sweep, path: Path, finished: dict[int, list[Row]]) -> None:
        self._sweep, self._path, self._rows = sweep, path, finished
        self._failed = sum(map(_has_error, finished.values()))
        self._progress = Progress("runs", len(sweep), len(finished))
        self._written_s, self._write_took_s = time.monotonic(), 0.0

    def run(self, options: argparse.Namespace) -> int:
        """Execute the missing runs, and keep what is there however that ends; return the exit code."""
        from thymio_sim_ros.batch_runs.engine import run_all

        missing = [number for number in range(len(self._sweep)) if number not in self._rows]
        resumed = len(self._rows)
        cluster = {key: getattr(options, key) for key in CLUSTER}
        self._write()
        with StopSignal() as stop:
            try:
                if missing:
                    with closing(run_all(partial(run_robots, self._sweep), missing, **cluster)) as results:
                        for outcomes in stop.until_signal(results):
                            for index, outcome in outcomes:
                                self._add(missing[index], outcome)
                            self._progress.show(len(self._rows), self._failed)
                            self._write_sometimes()
            finally:
                self._write()
                self._progress.end(len(self._rows), self._failed)
        summary = {"table": str(self._path), "runs": len(self._sweep), "finished": len(self._rows)}
        print_json({**summary, "resumed": resumed, "errors": self._failed})
        if stop.number is not None and len(self._rows) < len(self._sweep):
            print("thymio-sim: stopped; the same command continues the sweep", file=sys.stderr)
            exit_by_signal(stop.number)
        return FAILED if self._failed else 0

    def _add(self, number: int, outcome: list[Row] | Failure) -> None:
        if isinstance(outcome, Failure):
            self._failed += 1
            self._rows[number] = [failed_row(self._sweep, number, outcome.reason)]
        else:
            self._rows[number] = outcome

    def _write_sometimes(self) -> None:
        if time.monotonic() - self._written_s > max(WRITE_S, self._write_took_s / WRITE_SHARE):
            self._write()

    def _write(self) -> None:
        begun_s = time.monotonic()
        table.write_table(self._path, self._sweep, self._rows)
        self._written_s = time.monotonic()
        self._write_took_s = self._written_s - begun_s


def _description(options: argparse.Namespace) -> Description:
    """The description from file and options together."""
    description = Description() if options.file is None else read_description(options.file)
    given: dict[str, Any] = {
        key: getattr(options, key) for key in ("programs", "playgrounds", "seeds", "seconds", "measures", "limit_s")
    }
    changes = described({key: value for key, value in given.items() if value is not None})
    parameters = described({"parameters": dict(options.parameters or ())}).get("parameters", {})
    return replace(description, **changes, parameters={**description.parameters, **parameters})


def _default_output(file: Path | None) -> Path:
    return Path("sweep.csv") if file is None else Path(f"{file.stem}.csv")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="thymio-sim sweep",
        description="Run every program in every playground with every value of the parameters and every seed, without "
        "ROS, on all cores or on a cluster, and write a table with a row for each run and robot.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("file", metavar="FILE", nargs="?", type=path_argument, help="description in TOML or JSON")
    add = parser.add_argument
    add(
        "--program",
        dest="programs",
        type=_list_argument,
        metavar="A,B,…",
        help="behaviors or files (default: explorer)",
    )
    add(
        "--playground",
        dest="playgrounds",
        type=_list_argument,
        metavar="A,B,…",
        help="names or files (default: obstacle)",
    )
    add("--seeds", type=_seeds_argument, metavar="N|A,B,…", help="number of seeds, or the seeds (default: the seed 0)")
    add("--seconds", type=float, help="simulated seconds of a run (default: 60)")
    add(
        "--parameter",
        dest="parameters",
        action="append",
        type=_parameter_argument,
        metavar="NAME=A,B,…",
        help="values of a constant or variable of the program, of motors, proximity or noise, "
        "or of playground.ITEM.FIELD",
    )
    add(
        "--measure",
        dest="measures",
        type=_list_argument,
        metavar="A,B,…",
        help="measures (default: the first list below)",
    )
    add("--limit", dest="limit_s", type=float, metavar="S", help="processor time of a run in s (default: 600)")
    add(
        "-o",
        "--output",
        type=path_argument,
        metavar="FILE",
        help="table, in .csv or .parquet (default: that of FILE in .csv)",
    )
    add("--repeat-errors", action="store_true", help="execute runs again that have an error in the table")
    add_cluster_options(parser)
    return parser


def _list_argument(text: str) -> list[str]:
    return text.split(",")


def _seeds_argument(text: str) -> int | list[int]:
    try:
        seeds = [int(part) for part in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' found, expected a number of seeds, or seeds as 3,7") from None
    return seeds[0] if "," not in text else seeds


def _parameter_argument(text: str) -> tuple[str, list[object]]:
    name, equals, values = text.partition("=")
    if not (name and equals and values):
        raise argparse.ArgumentTypeError(f"'{text}' found, expected NAME=A,B,…")
    return name, [_value(part) for part in values.split(",")]


def _value(text: str) -> object:
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return {"true": True, "false": False}.get(text, text)
