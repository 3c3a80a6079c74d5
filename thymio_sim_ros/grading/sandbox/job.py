"""Job that the grader gives a sandbox, and the report that it gets back."""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from thymio_sim_ros.grading.assignment import Limits

__all__ = ["Job", "Outcome", "Report"]


@dataclass(frozen=True, slots=True)
class Job:
    """Files of an assignment and of one submission, and the tests that run: all in the order of `selected`.

    Without `selected`, the tests are only collected, and there is no submission.
    """

    level: str
    tests: tuple[str, ...]
    assignment: Mapping[str, bytes]
    submission: Mapping[str, bytes]
    selected: tuple[str, ...] | None
    limits: Limits
    handed_in: tuple[str, ...] = ()
    """Files that the submission must contain."""
    has_installed_ros: bool = False
    """Whether nodes are tested on an installed ROS 2, not on the embedded graph."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """The outcome of a test; see `results.Verdict`."""

    outcome: str
    message: str = ""
    output: str = ""
    cpu_s: float = 0.0
    files: Mapping[str, bytes] = field(default_factory=dict, repr=False)
    phase: str = ""
    """Phase in which the test ended if it did not pass: "setup", "call" or "teardown"."""


@dataclass(frozen=True, slots=True)
class Report:
    """Result of a job. `remark`: why the job as a whole failed; `collected`: tests and points, a fraction as text.

    `notes`: why test files were skipped; with a `remark`, the last line that was printed.
    """

    outcomes: Mapping[str, Outcome]
    collected: tuple[tuple[str, str], ...] = ()
    remark: str = ""
    notes: tuple[str, ...] = ()

    def to_json(self) -> str:
        """Return the report as text, with bytes in base64."""
        return json.dumps(asdict(self), default=lambda data: base64.b64encode(data).decode())

    @classmethod
    def from_json(cls, text: str) -> Report:
        """Return the report from the text of `to_json`."""
        data: dict[str, Any] = json.loads(text)
        outcomes = {
            test: Outcome(
                **{**fields, "files": {name: base64.b64decode(text) for name, text in fields["files"].items()}}
            )
            for test, fields in data["outcomes"].items()
        }
        collected = tuple((test, points) for test, points in data["collected"])
        return cls(outcomes, collected, data["remark"], tuple(data["notes"]))
