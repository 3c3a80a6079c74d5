"""Writes all reports of a class into a folder.

marks.csv            the table of the class
junit.xml            all verdicts
index.html           points of all submissions, with links
pupils/Anna-1a2b3c4d/     index.html, results.json (Gradescope), run logs of failed tests: what a pupil may get
teacher/Anna-1a2b3c4d.txt messages and output of all tests, hidden ones included
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path

from aseba_vm.cli.output import write_file
from thymio_sim_ros.grading.reports.csv_table import csv_table
from thymio_sim_ros.grading.reports.gradescope import gradescope_json
from thymio_sim_ros.grading.reports.junit import junit_xml
from thymio_sim_ros.grading.reports.page import index_page, submission_page
from thymio_sim_ros.grading.reports.texts import file_name
from thymio_sim_ros.grading.results import Graded, GradedTest

__all__ = ["remove_former", "write_reports", "write_submission"]

_OURS = re.compile(r".+-[0-9a-f]{8}(\.txt)?")


def write_reports(
    folder: Path, title: str, isolation: str, tests: Sequence[GradedTest], class_: Mapping[int, Graded]
) -> None:
    """Write the reports of the class, or of those graded so far, by position from 1. Raises OSError."""
    folder.mkdir(parents=True, exist_ok=True)
    ordered = [class_[position] for position in sorted(class_)]
    _write(folder / "marks.csv", csv_table(ordered, tests))
    _write(folder / "junit.xml", junit_xml(ordered))
    rows = {f"pupils/{file_name(graded)}/index.html": graded for graded in ordered}
    _write(folder / "index.html", index_page(title, isolation, rows))


def write_submission(folder: Path, graded: Graded) -> None:
    """Write the reports of one submission. Raises OSError."""
    name = file_name(graded)
    own = folder / "pupils" / name
    own.mkdir(parents=True, exist_ok=True)
    logs = {}
    for number, verdict in enumerate(graded.verdicts, start=1):
        if "run.jsonl" in verdict.files and not verdict.test.is_hidden:
            logs[verdict.test.name] = f"test-{number}.jsonl"
            write_file(str(own / f"test-{number}.jsonl"), verdict.files["run.jsonl"])
    _write(own / "index.html", submission_page(graded, logs))
    _write(own / "results.json", gradescope_json(graded))
    (folder / "teacher").mkdir(exist_ok=True)
    _write(folder / "teacher" / f"{name}.txt", _everything(graded))
    for log in own.glob("test-*.jsonl"):
        if log.name not in logs.values():  # of a submission that was replaced
            log.unlink()


def remove_former(folder: Path, class_: Mapping[int, Graded]) -> None:
    """Remove reports of submissions that are not in the class any more. Raises OSError."""
    names = {file_name(graded) for graded in class_.values()}
    for path in (*(folder / "pupils").glob("*"), *(folder / "teacher").glob("*.txt")):
        if _OURS.fullmatch(path.name) and path.name.removesuffix(".txt") not in names:
            if path.is_dir() and not path.is_symlink():
                shutil.rmtree(path)
            else:
                path.unlink()


def _everything(graded: Graded) -> str:
    lines = [graded.submission.name, graded.remark, *graded.submission.notes]
    for verdict in graded.verdicts:
        lines += ["", f"=== {verdict.test.name}: {verdict.outcome}, {verdict.cpu_s:.2f} s of CPU time"]
        lines += [verdict.message, verdict.output]
    return "\n".join(lines) + "\n"


def _write(path: Path, text: str) -> None:
    write_file(str(path), text.encode("utf-8", "replace"))
