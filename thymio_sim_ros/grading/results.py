"""Results of grading as values: tests with points, verdicts, submissions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from thymio_sim_ros.grading.submissions import Submission

__all__ = ["PASSED", "Graded", "GradedTest", "Verdict"]

PASSED = "passed"
"""The outcome that gives points; any other gives none."""


@dataclass(frozen=True, slots=True)
class GradedTest:
    """A test of the assignment: its pytest node ID and its points."""

    name: str
    points: Fraction
    is_hidden: bool = False


@dataclass(frozen=True, slots=True)
class Verdict:
    """The outcome of a test for a submission.

    `outcome` is "passed", "failed", "skipped", or the limit or event that ended it, such as "CPU time limit".
    """

    test: GradedTest
    outcome: str
    message: str = ""
    output: str = ""
    cpu_s: float = 0.0
    files: Mapping[str, bytes] = field(default_factory=dict, repr=False)
    """Files that explain a failure: `run.jsonl` (run log) and `trace.svg`."""

    @property
    def points(self) -> Fraction:
        """Points reached."""
        return self.test.points if self.outcome == PASSED else Fraction(0)


@dataclass(frozen=True, slots=True)
class Graded:
    """A graded submission: a verdict for each test, in the order of the assignment.

    `remark` is the reason why a submission as a whole has no points, or empty.
    """

    submission: Submission
    verdicts: Sequence[Verdict]
    remark: str = ""
    for_pupil: str = ""
    """Text for the pupil in place of a remark about the teacher's machine."""

    @property
    def points(self) -> Fraction:
        """Points reached."""
        return sum((verdict.points for verdict in self.verdicts), Fraction(0))

    @property
    def maximum(self) -> Fraction:
        """Points of all tests."""
        return sum((verdict.test.points for verdict in self.verdicts), Fraction(0))
