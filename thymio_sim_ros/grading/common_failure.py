"""Finds a set-up that fails for all submissions in the same way: a fault of the machine or the tests, not of pupils."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from thymio_sim_ros.grading.results import GradedTest
from thymio_sim_ros.grading.sandbox.job import Outcome, Report
from thymio_sim_ros.grading.submissions import Submission

__all__ = ["common_failure", "did_not_begin", "fails_in_setup"]

_STARTED = "before the first test"
"""Part of the remark of a submission whose tests did not begin."""


def did_not_begin(report: Report) -> bool:
    """Whether the tests of a submission ended before anything of it was loaded."""
    return _STARTED in report.remark


def fails_in_setup(submission: Submission, report: Report) -> bool:
    """Whether the tests of a submission did not begin, or one failed before it, without naming its files."""
    return did_not_begin(report) or any(_reason(submission, outcome) for outcome in report.outcomes.values())


def common_failure(graded: Iterable[tuple[Submission, Report]], tests: Sequence[GradedTest]) -> str:
    """Describe the first set-up that failed for all submissions for the same reason; empty if there is none."""
    runs = list(graded)
    remarks = {report.remark for _, report in runs}
    if len(remarks) == 1 and _STARTED in (remark := remarks.pop()):
        return remark
    for test in tests:
        reasons = {_reason(submission, report.outcomes.get(test.name)) for submission, report in runs}
        if test.points and len(reasons) == 1 and (reason := reasons.pop()):
            return f"{test.name}: {reason}"
    return ""


def _reason(submission: Submission, outcome: Outcome | None) -> str:
    """The last line of a failure, or of a skip, of a set-up that is not by a file of the submission; else empty."""
    if outcome is None or outcome.phase != "setup" or outcome.outcome == "passed":
        return ""
    if any(name.rpartition("/")[2] in outcome.message for name in submission.files):
        return ""
    return outcome.message.strip().rpartition("\n")[2].removeprefix("E").strip() or outcome.outcome
