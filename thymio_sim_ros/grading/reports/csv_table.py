"""The class as a table: one row for each submission, one column for each test. Equal marks give an equal file."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence

from thymio_sim_ros.grading.reports.texts import number, short_names, shown_name, shown_remark
from thymio_sim_ros.grading.results import Graded, GradedTest

__all__ = ["csv_table"]

_FORMULA = ("=", "+", "-", "@", "\t", "\r")


def csv_table(class_: Sequence[Graded], tests: Sequence[GradedTest]) -> str:
    """The table as CSV: name, id, points, maximum, verdict, points of each test, remark."""
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(["name", "id", "points", "maximum", "verdict", *short_names(list(tests)), "remark"])
    for graded in class_:
        points = [number(verdict.points) for verdict in graded.verdicts]
        submission = graded.submission
        row = [
            shown_name(graded),
            submission.identifier,
            number(graded.points),
            number(graded.maximum),
            _verdict(graded),
        ]
        table.writerow(map(_plain, [*row, *points, shown_remark(graded)]))
    return text.getvalue()


def _verdict(graded: Graded) -> str:
    """The outcomes that cost points, each once; "passed" if there are none."""
    if graded.remark:
        return "not graded" if graded.submission.problem else "stopped"
    outcomes = dict.fromkeys(verdict.outcome for verdict in graded.verdicts if verdict.outcome != "passed")
    return ", ".join(outcomes) or "passed"


def _plain(text: str) -> str:
    """A cell that no spreadsheet takes for a formula: names of files are chosen by pupils."""
    return f"'{text}" if text.startswith(_FORMULA) else text
