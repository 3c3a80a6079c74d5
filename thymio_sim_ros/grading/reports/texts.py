"""Texts that all reports share."""

from __future__ import annotations

import hashlib
import re
import unicodedata
from dataclasses import replace
from fractions import Fraction

from thymio_sim_ros.grading.results import Graded, GradedTest, Verdict

__all__ = ["file_name", "number", "pupil_remark", "short_names", "shown_message", "shown_name", "shown_remark"]

_CONTROLS = re.compile(r"[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_NOT_ON_A_LINE = re.compile(r"[\x00-\x1f\x7f-\x9f\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff\ufffe\uffff]")
"""Controls, line breaks, and characters that make following text run backward."""
_HIDDEN = "a hidden test"
_LONGEST_NAME = 50
"""Characters, of at most four bytes: file systems have names of 255 bytes."""


def number(value: Fraction) -> str:
    """Points with at most two decimals, as 2, 0.5 or 0.33."""
    return f"{float(value):.2f}".rstrip("0").rstrip(".")


def file_name(graded: Graded) -> str:
    """A file name for a submission, without suffix, which depends on no other submission.

    It is the name in its own letters, and eight digits that distinguish equal and similar names.
    """
    submission = graded.submission
    name = submission.name.removesuffix(f" ({submission.identifier})")  # added where others have the same name
    letters = "".join(
        character if unicodedata.category(character)[0] in "LMN" else "-"
        for character in unicodedata.normalize("NFC", name)
    )
    readable = re.sub("-+", "-", letters).strip("-")[:_LONGEST_NAME] or "submission"
    owner = f"{name}\0{submission.key or submission.identifier}".encode("utf-8", "surrogatepass")
    return f"{readable}-{hashlib.sha256(owner).hexdigest()[:8]}"


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


def pupil_remark(graded: Graded) -> str:
    """The same for the pupil, who has nothing to do with the machine of the teacher."""
    return shown_remark(replace(graded, remark=graded.for_pupil or graded.remark))
