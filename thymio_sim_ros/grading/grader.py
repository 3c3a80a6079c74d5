"""Grades the submissions of a class in sandboxes, on threads that wait for them or on a Dask cluster."""

from __future__ import annotations

import socket
from collections.abc import Generator, Sequence
from contextlib import closing
from fractions import Fraction
from functools import partial

from thymio_sim_ros.batch_runs.failure import Failure
from thymio_sim_ros.batch_runs.threads import run_in_threads
from thymio_sim_ros.grading.assignment import Assignment, Limits
from thymio_sim_ros.grading.common_failure import did_not_begin
from thymio_sim_ros.grading.errors import DestroyedError, GradingError
from thymio_sim_ros.grading.limit_reasons import limit_in
from thymio_sim_ros.grading.results import Graded, GradedTest, Verdict
from thymio_sim_ros.grading.sandbox.job import Job, Outcome, Report
from thymio_sim_ros.grading.sandbox.levels import run_job, why_unavailable
from thymio_sim_ros.grading.submissions import Submission

__all__ = ["collect", "graded", "run_submission", "run_submissions"]

_NO_VERDICT = "not run"
_NOT_GRADED = "could not be graded"
_ASK = f"{_NOT_GRADED}: ask your teacher, it is not the fault of your program"
_DESTROYED = "the tests were ended from outside, perhaps by the program: remove what ends other programs"


def collect(assignment: Assignment, level: str) -> tuple[GradedTest, ...]:
    """Return the tests of an assignment. Raises GradingError if they cannot be collected without a submission."""
    job = Job(
        level,
        assignment.tests,
        assignment.content,
        {},
        None,
        assignment.limits,
        has_installed_ros=assignment.has_installed_ros,
    )
    report = run_job(job)
    if not report.collected or report.notes:
        reason = ": ".join(filter(None, [report.remark, "; ".join(report.notes)])) or "no tests found"
        raise GradingError(
            f"assignment {assignment.name}: not all of its tests can be collected without a submission: {reason}"
        )
    return tuple(GradedTest(name, Fraction(points), assignment.is_hidden(name)) for name, points in report.collected)


def run_submissions(
    submissions: Sequence[Submission],
    assignment: Assignment,
    tests: Sequence[GradedTest],
    level: str,
    *,
    workers: int | None = None,
    scheduler: str = "",
    dashboard: str = "",
) -> Generator[list[tuple[int, Report | Failure]], None, None]:
    """Run the tests on submissions, each in a sandbox of its own; yield the reports as they come.

    Each comes once, with the index of its submission, in any order; an empty list comes twice a second. A `Failure` is
    no verdict: the machine could not grade. `workers`: sandboxes at the same time on this machine (None: one per core).
    `scheduler`, `dashboard`: see `batch_runs.engine.run_all`; without both there is no cluster. Raises EngineError.
    """
    names = tuple(test.name for test in tests)
    function = partial(run_submission, assignment=assignment, tests=names, level=level)
    if not scheduler and not dashboard:  # the processes of a cluster would only wait for those of the submissions
        with closing(run_in_threads(function, submissions, workers=workers)) as outcomes:
            yield from outcomes
        return
    from thymio_sim_ros.batch_runs.engine import run_all

    cluster = {"workers": workers, "scheduler": scheduler, "dashboard": dashboard}
    with closing(run_all(function, submissions, group_s=0.0, **cluster)) as outcomes:  # type: ignore[arg-type]
        yield from outcomes


def run_submission(submission: Submission, *, assignment: Assignment, tests: tuple[str, ...], level: str) -> Report:
    """Run the tests on a submission. One that destroys its sandbox has a report with a remark and no verdicts.

    Raises GradingError if this machine does not have the level of isolation, or the sandbox fails by itself.
    """
    if reason := why_unavailable(level):
        raise GradingError(f"isolation {level} is not available on {socket.gethostname()}: {reason}")
    outcomes: dict[str, Outcome] = {}
    for part in assignment.parts():
        selected = tuple(test for test in tests if test.partition("::")[0] in part.tests)
        job = Job(
            level,
            part.tests,
            part.content,
            submission.files,
            selected,
            part.limits,
            assignment.expected,
            part.has_installed_ros,
        )
        try:
            report = run_job(job)
        except DestroyedError as error:
            return Report({}, remark=f"{_DESTROYED} ({error})")
        if report.remark:  # what is printed beside hidden tests is not for pupils
            notes = () if assignment.hidden.issuperset(part.tests) else report.notes
            return Report({}, remark=": ".join([report.remark, *notes]))
        outcomes |= report.outcomes
    return Report(outcomes)


def graded(
    submission: Submission, tests: Sequence[GradedTest], report: Report | Failure | None, limits: Limits
) -> Graded:
    """Return the verdicts of a report; None: the submission has a problem and was not run."""
    if report is None:
        return _without_points(submission, tests, submission.problem)
    if isinstance(report, Failure):
        return _without_points(submission, tests, f"{_NOT_GRADED}: {report.reason}", for_pupil=_ASK)
    if report.remark:
        return _without_points(submission, tests, report.remark, for_pupil=_ASK if did_not_begin(report) else "")
    return Graded(submission, [_verdict(test, report.outcomes.get(test.name), limits) for test in tests])


def _verdict(test: GradedTest, outcome: Outcome | None, limits: Limits) -> Verdict:
    if outcome is None:
        return Verdict(test, _NO_VERDICT, "it was not run: the tests before it took all the time that there is")
    verdict, message = outcome.outcome, outcome.message
    if verdict == "failed" and (found := limit_in(message, limits)):
        verdict, message = found[0], f"{found[1]}\n\n{message}"
    return Verdict(test, verdict, message, outcome.output, outcome.cpu_s, outcome.files)


def _without_points(submission: Submission, tests: Sequence[GradedTest], remark: str, *, for_pupil: str = "") -> Graded:
    verdicts = [Verdict(test, _NO_VERDICT, for_pupil or remark) for test in tests]
    return Graded(submission, verdicts, remark, for_pupil)
