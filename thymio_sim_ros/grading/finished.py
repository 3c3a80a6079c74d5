"""Reports of submissions in a folder: an interrupted grading continues, and a late submission costs only itself."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path

from aseba_vm.cli.output import write_file
from thymio_sim_ros import __version__
from thymio_sim_ros.grading.assignment import Assignment
from thymio_sim_ros.grading.sandbox.job import Report
from thymio_sim_ros.grading.submissions import Submission

__all__ = ["FinishedReports"]


class FinishedReports:
    """Finds the report of the same files, tests, limits, graph and version. Invariant: each file is complete."""

    def __init__(self, folder: Path, assignment: Assignment) -> None:
        self._folder = folder
        limits = json.dumps(asdict(assignment.limits)).encode()
        tests = json.dumps([assignment.tests, assignment.has_installed_ros]).encode()
        self._assignment = _digest(__version__.encode(), tests, limits, *_parts(assignment.content))

    def find(self, submission: Submission) -> Report | None:
        """Return the report of a submission, or None if it has not been graded. Raises OSError."""
        try:
            return Report.from_json(self._path(submission).read_text(encoding="utf-8"))
        except (FileNotFoundError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
            return None  # missing, or changed by hand

    def add(self, submission: Submission, report: Report) -> None:
        """Keep a report. Raises OSError."""
        self._folder.mkdir(parents=True, exist_ok=True)
        write_file(str(self._path(submission)), report.to_json().encode())

    def _path(self, submission: Submission) -> Path:
        return self._folder / f"{_digest(self._assignment.encode(), *_parts(submission.files))}.json"


def _parts(files: Mapping[str, bytes]) -> list[bytes]:
    """Names and contents of files, in order of name."""
    return [part for name in sorted(files) for part in (name.encode("utf-8", "surrogatepass"), files[name])]


def _digest(*parts: bytes) -> str:
    total = hashlib.sha256()
    for part in parts:
        total.update(hashlib.sha256(part).digest())
    return total.hexdigest()
