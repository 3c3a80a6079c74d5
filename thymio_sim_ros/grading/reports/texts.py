"""Texts that all reports share."""

from __future__ import annotations

import re
from fractions import Fraction

from thymio_sim_ros.grading.results import Graded, GradedTest, Verdict

__all__ = ["file_name", "number", "short_names", "shown_message", "shown_name", "shown_remark"]

_CONTROLS = re.compile(r"[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_NOT_ON_A_LINE = re.compile(r"[\x00-\x1f\x7f-\x9f\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff\ufffe\uffff]")
"""Controls, line breaks, and characters that make following text run backward."""
_HIDDEN = "a hidden test"


def number(value: Fraction) -> str:
    """Points with at most two decimals, as 2, 0.5 or 0.33."""
    return f"{float(value):.2f}".rstrip("0").rstrip(".")


def file_name(graded: Graded, position: int) -> str:
    """A file name for a submission, without suffix; `position` tells submissions with the same name apart."""
    return f"{position:03d}-{re.sub(r'[^A-Za-z0-9]+', '-', graded.submission.name).strip('-')[:60] or 'submission'}"


def short_names(tests: list[GradedTest]) -> list[str]:
    """Names of tests without their file, unless two files have a test of the same name."""
    short = [test.name.partition("::")[2] or test.name for test in tests]
    return [name if short.count(name) == 1 else test.name for name, test in zip(short, tests, strict=True)]


def shown_message(verdict: Verdict) -> str:
    """Message and output as pupils may see them, without characters that XML refuses."""
    if verdict.test.is_hidden:
        return "" if verdict.outcome == "passed" else _HIDDEN
    parts = [verdict.message, f"output:\n{verdict.output}" if verdict.output else ""]
    return _CONTROLS.sub("\ufffd", "\n\n".join(filter(None, parts)))


def shown_name(graded: Graded) -> str:
    """Name of a submission on one line: it may come from a file name, and goes to a terminal, a table and XML."""
    return _NOT_ON_A_LINE.sub("\ufffd", graded.submission.name)


def shown_remark(graded: Graded) -> str:
    """Remark and notes of a submission as one line."""
    return _NOT_ON_A_LINE.sub(" ", "; ".join(filter(None, [graded.remark, *graded.submission.notes])))
