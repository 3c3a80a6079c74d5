"""The command `thymio-sim grade`: grade the submissions of a class, each in a sandbox of its own."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path

from aseba_vm.cli.output import STANDARD_OUTPUT, standard_output
from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.cli.options import number_argument
from thymio_sim_ros.grading import assignment as assignments
from thymio_sim_ros.grading import grader, submissions
from thymio_sim_ros.grading.errors import GradingError
from thymio_sim_ros.grading.reports.folder import write_reports, write_submission
from thymio_sim_ros.grading.reports.texts import number, shown_remark
from thymio_sim_ros.grading.results import Graded
from thymio_sim_ros.grading.sandbox.levels import LEVELS, best_level, why_unavailable

__all__ = ["run"]

EXAMPLE = """\
SUBMISSIONS is a folder or zip with a folder, file or zip for each pupil, also as exported by Moodle or Canvas.
FILE is a pytest file, or a TOML file that names tests, hidden tests, expected files and limits
(docs/grading-a-class.md).

exit code: 0 all submissions have been graded, whatever their marks; 2 rejected input

example:
  thymio-sim grade submissions/ --assignment test_follower.py --output grades
"""


def run(argv: Sequence[str]) -> int:
    """Grade a class; return the exit code. Raises UsageError for input that cannot be used."""
    options = _parser().parse_args(argv)
    try:
        assignment = assignments.load(options.assignment)
        found = submissions.find(options.submissions)
        level = _level(options.isolation)
        tests = grader.collect(assignment, level)
        options.output.mkdir(parents=True, exist_ok=True)
        _print(f"isolation: {level} ({LEVELS[level]})")
        total = number(sum((test.points for test in tests), start=type(tests[0].points)(0)))
        _print(f"{len(found)} submissions, {len(tests)} tests, {total} points")
        class_: list[Graded] = []
        for graded in grader.grade(found, assignment, tests, level, grader.local_map(options.workers)):
            class_.append(graded)
            write_submission(options.output, graded, len(class_))
            _print(_line(graded))
        write_reports(options.output, assignment.name, f"{level} ({LEVELS[level]})", tests, class_)
    except GradingError as error:
        raise UsageError(str(error)) from error
    except OSError as error:
        if error.filename == STANDARD_OUTPUT or isinstance(error, BrokenPipeError):
            raise
        raise UsageError(f"{error.filename}: {error.strerror}; expected a folder that can be written") from error
    _print(f"written: {options.output / 'marks.csv'}, {options.output / 'index.html'}, {options.output / 'junit.xml'}")
    return 0


def _level(wanted: str) -> str:
    if wanted == "auto":
        return best_level()
    reason = why_unavailable(wanted)
    if reason:
        raise GradingError(f"--isolation {wanted}: not available here: {reason}")
    if wanted == "limits":
        print(f"thymio-sim grade: no isolation: {LEVELS[wanted]}", file=sys.stderr)
    return wanted


def _line(graded: Graded) -> str:
    remark = shown_remark(graded)
    points = f"{number(graded.points)}/{number(graded.maximum)}"
    return f"{points:>8}  {graded.submission.name}" + (f": {remark}" if remark else "")


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
    parser.add_argument("--assignment", type=Path, required=True, metavar="FILE", help="tests: *.py or *.toml")
    parser.add_argument(
        "-o", "--output", type=Path, default=Path("grades"), metavar="DIR", help="folder to write (default: grades)"
    )
    parser.add_argument(
        "--workers",
        type=_workers_argument,
        default=os.cpu_count() or 1,
        metavar="N",
        help="submissions at the same time (default: the number of cores); the marks do not depend on it",
    )
    levels = "; ".join(f"{name}: {about}" for name, about in LEVELS.items())
    parser.add_argument(
        "--isolation",
        choices=["auto", *LEVELS],
        default="auto",
        help=f"auto: the strongest that this machine gives, but never `limits`. {levels}",
    )
    return parser


def _workers_argument(text: str) -> int:
    return int(number_argument(text, 1, 1000))
