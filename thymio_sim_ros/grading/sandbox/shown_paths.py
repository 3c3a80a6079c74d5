"""Paths in reports: folders of the machine and of the sandbox are left out, because they do not help pupils."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from thymio_sim_ros.grading.sandbox.job import Report
from thymio_sim_ros.grading.sandbox.readable import PACKAGE_FOLDER, package_folders

__all__ = ["without_folders"]


def without_folders(report: Report, folder: Path) -> Report:
    """Return a report whose paths begin in the folder of the tests, in a package, or in Python's library."""
    folders = sorted({str(one) for one in _folders(folder)} - {os.sep, ""}, key=len, reverse=True)

    def short(text: str) -> str:
        for one in folders:
            text = text.replace(f"{one}{os.sep}", "")
        return text

    outcomes = {
        test: replace(one, message=short(one.message), output=short(one.output))
        for test, one in report.outcomes.items()
    }
    return replace(report, outcomes=outcomes, remark=short(report.remark), notes=tuple(map(short, report.notes)))


def _folders(folder: Path) -> Iterator[Path | str]:
    for name in ("work", "assignment", "tmp", "out"):
        yield folder / name
    yield PACKAGE_FOLDER
    yield from package_folders()
    yield os.path.dirname(os.__file__)
    yield from (sys.prefix, sys.base_prefix, sys.exec_prefix, os.path.expanduser("~"))
