"""The command `thymio-sim grade`: grade the submissions of a class, each in a sandbox of its own."""

from __future__ import annotations

import argparse
import re
import sys
import time
from collections.abc import Sequence
from contextlib import closing
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

from aseba_vm.cli.output import STANDARD_OUTPUT, exit_by_signal, standard_output
from thymio_sim_ros.batch_runs.errors import EngineError
from thymio_sim_ros.batch_runs.failure import Failure
from thymio_sim_ros.cli.batch import CLUSTER, Progress, add_cluster_options, check_dask
from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.cli.mission_assignment import mission_assignment, with_mission
from thymio_sim_ros.cli.ros.graph_choice import check_ros
from thymio_sim_ros.cli.signal_handling import StopSignal
from thymio_sim_ros.grading import assignment as assignments
from thymio_sim_ros.grading import grader, submissions
from thymio_sim_ros.grading.assignment import Assignment
from thymio_sim_ros.grading.common_failure import common_failure, fails_in_setup
from thymio_sim_ros.grading.errors import GradingError
from thymio_sim_ros.grading.finished import FinishedReports
from thymio_sim_ros.grading.reports.folder import remove_former, write_reports, write_submission
from thymio_sim_ros.grading.reports.texts import number, shown_name, shown_remark
from thymio_sim_ros.grading.results import Graded, GradedTest
from thymio_sim_ros.grading.sandbox.job import Report
from thymio_sim_ros.grading.sandbox.levels import LEVELS, best_level, why_unavailable
from thymio_sim_ros.grading.submissions import Submission

__all__ = ["check_system", "run"]

FAILED = 1
WRITE_S = 5.0
"""Time between two tables while submissions are graded."""

_TESTS, _MISSIONS = (".py", ".toml"), (".json", ".zip")
_OPEN = ("limits", "process")
"""Levels that do not protect files."""
_RUNS_PROGRAM = re.compile(rb"\bros\.run\(")

EXAMPLE = """\
SUBMISSIONS is a folder or zip with a folder, file or zip for each pupil, also as exported by Moodle or Canvas.
FILE is a pytest file, a TOML file that names tests, hidden tests, expected files and limits
(docs/grading-a-class.md), or a mission, whose stars are points (docs/missions.md). The same command continues an
interrupted grading, and grades only what is new or changed.

exit code: 0 all submissions have been graded, whatever their marks; 1 a machine could not grade some of them (column
`remark`), or the same set-up failed for all; 2 rejected input, a solution without all points, or a cluster that cannot
be used

example:
  thymio-sim grade submissions/ --assignment test_follower.py --output grades
"""


def run(argv: Sequence[str]) -> int:
    """Grade a class; return the exit code. Raises UsageError for input that cannot be used."""
    options = _parser().parse_args(argv)
    if options.scheduler or options.dashboard:
        check_dask("grade")
    if options.ros:
        check_ros()
    try:
        assignment = replace(_assignment(options.assignment), has_installed_ros=options.ros)
        handed_in = submissions.find(options.submissions)
        prepared = [submissions.prepared(submission, assignment.expected) for submission in handed_in]
        check_system(assignment)
        level = _level(options.isolation)
        tests = grader.collect(assignment, level)
        _print(f"isolation: {level} ({LEVELS[level]})")
        total = number(sum((test.points for test in tests), start=Fraction(0)))
        _print(f"{len(prepared)} submissions, {len(tests)} tests, {total} points")
        if hidden := assignment.hidden_data():
            _print(f"for hidden tests only: {', '.join(hidden)}")
        if assignment.solution is not None:
            _check_solution(assignment, assignment.solution, tests, level)
        return _Execution(options, assignment, prepared, tests, level).run()
    except (GradingError, EngineError) as error:
        raise UsageError(str(error)) from error
    except OSError as error:
        if error.filename == STANDARD_OUTPUT or isinstance(error, BrokenPipeError):
            raise
        raise UsageError(f"{error.filename}: {error.strerror}; expected a folder that can be written") from error


class _Execution:
    """The grading of a class. Invariant: the reports of each graded submission have been written."""

    def __init__(
        self,
        options: argparse.Namespace,
        assignment: Assignment,
        handed_in: Sequence[Submission],
        tests: Sequence[GradedTest],
        level: str,
    ) -> None:
        self._options, self._assignment, self._submissions, self._tests = options, assignment, handed_in, tests
        self._level, self._output = level, options.output
        self._finished = FinishedReports(options.output / "finished", assignment)
        self._reports: dict[int, Report] = {}
        self._class: dict[int, Graded] = {}
        """Graded submissions by position from 1."""
        self._printed = 0
        self._not_graded = 0
        self._written_s = time.monotonic()

    def run(self) -> int:
        """Grade what has not been graded before; return the exit code."""
        missing = self._add_finished()
        if resumed := len(self._class):
            _print(f"{resumed} need no run: graded before ({self._output / 'finished'}), or nothing to grade")
        progress = Progress("submissions", len(self._submissions), resumed)
        with StopSignal() as stop:
            try:
                if missing:
                    self._run(missing, stop, progress)
            finally:
                self._write()
                progress.end(len(self._class), self._not_graded)
        if stop.number is not None and len(self._class) < len(self._submissions):
            print("thymio-sim: stopped; the same command continues the grading", file=sys.stderr)
            exit_by_signal(stop.number)
        remove_former(self._output, self._class)
        _print("written: " + ", ".join(str(self._output / name) for name in ("marks.csv", "index.html", "junit.xml")))
        runs = [(self._submissions[position - 1], report) for position, report in sorted(self._reports.items())]
        if self._assignment.solution is None and (failure := common_failure(runs, self._tests)):
            print(
                f"thymio-sim grade: the marks are worth nothing: the same set-up failed for all submissions: {failure}."
                " Mend machine or test, then give the same command again",
                file=sys.stderr,
            )
            return FAILED
        return FAILED if self._not_graded else 0

    def _run(self, missing: Sequence[int], stop: StopSignal, progress: Progress) -> None:
        cluster = {key: getattr(self._options, key) for key in CLUSTER}
        waiting = [self._submissions[position - 1] for position in missing]
        runs = grader.run_submissions(waiting, self._assignment, self._tests, self._level, **cluster)
        with closing(runs) as reports:
            for some in stop.until_signal(reports):
                if some:
                    progress.clear()
                for index, report in some:
                    self._add(missing[index], report)
                progress.show(len(self._class), self._not_graded)
                if some and time.monotonic() - self._written_s > WRITE_S:
                    self._write()

    def _add_finished(self) -> list[int]:
        """Add what needs no run; return the positions of the other submissions."""
        missing = []
        for position, submission in enumerate(self._submissions, start=1):
            report = None if self._options.again or submission.problem else self._finished.find(submission)
            if report or submission.problem:
                self._add(position, report)
            else:
                missing.append(position)
        return missing

    def _add(self, position: int, report: Report | Failure | None) -> None:
        submission = self._submissions[position - 1]
        graded = self._class[position] = grader.graded(submission, self._tests, report, self._assignment.limits)
        write_submission(self._output, graded)
        if isinstance(report, Failure):
            self._not_graded += 1
        elif report is not None:
            self._reports[position] = report
            if not fails_in_setup(submission, report):  # the machine may be mended before the next call
                self._finished.add(submission, report)
        while self._printed + 1 in self._class:  # in the order of the class
            self._printed += 1
            _print(_line(self._class[self._printed]))

    def _write(self) -> None:
        isolation = f"{self._level} ({LEVELS[self._level]})"
        write_reports(self._output, self._assignment.name, isolation, self._tests, self._class)
        self._written_s = time.monotonic()


def _assignment(path: Path) -> Assignment:
    """The assignment of a file with tests, or of a mission: a file, or the name of a shipped one."""
    if path.suffix in _TESTS or (path.suffix not in _MISSIONS and path.exists()):
        return with_mission(assignments.load(path))
    return mission_assignment(str(path))


def _check_solution(assignment: Assignment, path: Path, tests: Sequence[GradedTest], level: str) -> None:
    """Grade the solution of the assignment. Raises GradingError with the first test in which it loses points."""
    submission = submissions.prepared(submissions.read_one(path), assignment.expected)
    names = tuple(test.name for test in tests)
    report = None
    if not submission.problem:
        report = grader.run_submission(submission, assignment=assignment, tests=names, level=level)
    result = grader.graded(submission, tests, report, assignment.limits)
    points = f"{number(result.points)} of {number(result.maximum)}"
    if result.points < result.maximum:
        lost = next(verdict for verdict in result.verdicts if verdict.points < verdict.test.points)
        reason = result.remark or f"{lost.test.name}: {lost.outcome}: {lost.message.strip().rpartition(chr(10))[2]}"
        raise GradingError(
            f"the solution {path} has {points} points, expected all: mend test, solution or machine: {reason}"
        )
    _print(f"solution: {points} points")


def check_system(assignment: Assignment) -> None:
    """Raise GradingError if the tests need what this system lacks."""
    if sys.platform == "win32":
        for test in assignment.tests:
            if _RUNS_PROGRAM.search(assignment.content[test]):
                raise GradingError(f"{test}: found ros.run on Windows, expected ros.start: or grade in WSL 2")


def _level(wanted: str) -> str:
    level = best_level() if wanted == "auto" else wanted
    if wanted != "auto" and (reason := why_unavailable(wanted)):
        raise GradingError(f"--isolation {wanted}: not available here: {reason}")
    if level in _OPEN:
        print(
            f"thymio-sim grade: no isolation: {LEVELS[level]}. Grade only programs that you would start yourself; "
            "Linux isolates them (on Windows: WSL 2)",
            file=sys.stderr,
        )
    return level


def _line(graded: Graded) -> str:
    remark = shown_remark(graded)
    points = f"{number(graded.points)}/{number(graded.maximum)}"
    return f"{points:>8}  {shown_name(graded)}" + (f": {remark}" if remark else "")


def _print(text: str) -> None:
    with standard_output():
        print(text, flush=True)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="thymio-sim grade",
        description="Grade the submissions of a class, each in a process of its own with limits and isolation.",
        epilog=EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("submissions", type=Path, metavar="SUBMISSIONS", help="folder or zip of the class")
    parser.add_argument(
        "--assignment", type=Path, required=True, metavar="FILE", help="tests: *.py or *.toml; or a mission"
    )
    parser.add_argument(
        "-o", "--output", type=Path, default=Path("grades"), metavar="DIR", help="folder to write (default: grades)"
    )
    levels = "; ".join(f"{name}: {about}" for name, about in LEVELS.items())
    parser.add_argument(
        "--isolation",
        choices=["auto", *LEVELS],
        default="auto",
        help=f"auto: the strongest that this machine gives; on Linux neither `limits` nor `process`. {levels}",
    )
    parser.add_argument(
        "--ros", action="store_true", help="test ROS nodes on an installed ROS 2 (default: on the embedded graph)"
    )
    parser.add_argument("--again", action="store_true", help="grade everything, also what was graded before")
    add_cluster_options(parser)
    return parser
