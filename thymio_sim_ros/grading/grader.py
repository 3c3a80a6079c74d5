"""Grades the submissions of a class in sandboxes, several at a time; results are in the order of the submissions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from functools import partial

from thymio_sim_ros.grading.assignment import Assignment
from thymio_sim_ros.grading.errors import GradingError
from thymio_sim_ros.grading.results import Graded, GradedTest, Verdict
from thymio_sim_ros.grading.sandbox.job import Job, Outcome
from thymio_sim_ros.grading.sandbox.levels import run_job
from thymio_sim_ros.grading.submissions import Submission, prepared

__all__ = ["Map", "collect", "grade", "grade_one", "local_map"]

Map = Callable[[Callable[[Submission], Graded], Iterable[Submission]], Iterable[Graded]]
"""Applies a function to all submissions, as `map` does. An engine for several machines is another such function."""

_NO_VERDICT = "not run"


def collect(assignment: Assignment, level: str) -> tuple[GradedTest, ...]:
    """Return the tests of an assignment. Raises GradingError if they cannot be collected without a submission."""
    job = Job(level, assignment.tests, assignment.content, {}, None, assignment.limits)
    report = run_job(job)
    if not report.collected:
        reason = report.remark or "; ".join(report.notes) or "no tests found"
        raise GradingError(
            f"assignment {assignment.name}: its tests cannot be collected without a submission: {reason}"
        )
    return tuple(GradedTest(name, Fraction(points), assignment.is_hidden(name)) for name, points in report.collected)


def grade(
    submissions: Sequence[Submission],
    assignment: Assignment,
    tests: Sequence[GradedTest],
    level: str,
    apply: Map = map,
) -> Iterator[Graded]:
    """Grade submissions in sandboxes of a level; yield the results in the same order."""
    yield from apply(partial(grade_one, assignment=assignment, tests=tuple(tests), level=level), submissions)


def local_map(workers: int) -> Map:
    """A `Map` that uses this machine, with so many sandboxes at a time."""

    def apply(function: Callable[[Submission], Graded], submissions: Iterable[Submission]) -> Iterator[Graded]:
        pool = ThreadPoolExecutor(workers)  # its threads only wait: each starts a process
        try:
            yield from pool.map(function, submissions)
        finally:
            pool.shutdown(cancel_futures=True)  # Ctrl-C has reached the sandboxes, too

    return apply


def grade_one(submission: Submission, *, assignment: Assignment, tests: tuple[GradedTest, ...], level: str) -> Graded:
    """Grade a submission. A submission that destroys its sandbox gets no points."""
    submission = prepared(submission, assignment.expected)
    if submission.problem:
        return _without_points(submission, tests, submission.problem)
    names = tuple(test.name for test in tests)
    job = Job(level, assignment.tests, assignment.content, submission.files, names, assignment.limits)
    try:
        report = run_job(job)
    except GradingError as error:
        return _without_points(submission, tests, str(error))
    if report.remark:
        return _without_points(submission, tests, report.remark)
    verdicts = [_verdict(test, report.outcomes.get(test.name)) for test in tests]
    return Graded(submission, verdicts)


def _verdict(test: GradedTest, outcome: Outcome | None) -> Verdict:
    if outcome is None:
        return Verdict(test, _NO_VERDICT, "a limit of the submission as a whole was reached before")
    return Verdict(test, outcome.outcome, outcome.message, outcome.output, outcome.cpu_s, outcome.files)


def _without_points(submission: Submission, tests: Sequence[GradedTest], remark: str) -> Graded:
    return Graded(submission, [Verdict(test, _NO_VERDICT, remark) for test in tests], remark)
