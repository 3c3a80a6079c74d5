"""The report of a test process, checked line by line: an unexpected line is an attempt to forge it.

A line is a JSON object with the secret of the process and its kind:

    {"secret": "…", "do": "collected", "tests": [["test_it.py::test_a", "3"]], "notes": []}
    {"secret": "…", "do": "begin", "test": "test_it.py::test_a"}
    {"secret": "…", "do": "result", "test": "test_it.py::test_a", "outcome": "failed", "phase": "call", "message": "…"}
    {"secret": "…", "do": "end"}

Every test has one begin and one result, in the order in which they were selected. A test without a result has no
points. A test begins when the supervisor answers to its begin.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["ForgedError", "ReportProtocol"]

_OUTCOMES = ("passed", "failed", "skipped")
_PHASES = ("", "setup", "call", "teardown")
_KINDS = ("collected", "broken", "begin", "result", "end")


class ForgedError(ThymioSimError):
    """A line that the test process has not written."""


class ReportProtocol:
    """Checks the lines of one test process. Invariant: results are those of tests that had begun, each once."""

    def __init__(self, secret: str, selected: Sequence[str] | None) -> None:
        """`selected`: the tests that must be collected, in order; None: any."""
        self._secret = secret
        self._selected = selected
        self._pending: list[str] = []
        self.collected: tuple[tuple[str, str], ...] | None = None
        self.notes: tuple[str, ...] = ()
        self.current = ""
        """The test that runs now, or empty."""
        self.is_complete = False

    def read(self, line: bytes) -> tuple[str, dict[str, Any]]:
        """Return kind and content of a line. Raises ForgedError for any line that is not expected now."""
        try:
            data = json.loads(line)
            if data["secret"] != self._secret or self.is_complete:
                raise ForgedError("a line that the tests did not write")
            kind = data["do"]
            if kind not in _KINDS:
                raise ForgedError("a line of an unknown kind")
            getattr(self, f"_{kind}")(data)
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
            raise ForgedError("a line that is no report") from error
        return kind, data

    def _collected(self, data: dict[str, Any]) -> None:
        tests = tuple((str(test), str(points)) for test, points in data["tests"])
        names = [test for test, _ in tests]
        if self.collected is not None or (self._selected is not None and names != list(self._selected)):
            raise ForgedError("other tests than those of the assignment")
        self.collected, self._pending = tests, names
        self.notes = tuple(map(str, data["notes"]))

    def _broken(self, data: dict[str, Any]) -> None:
        if self.collected is not None:
            raise ForgedError("tests that could be collected before")
        self.notes = (str(data["message"]),)

    def _begin(self, data: dict[str, Any]) -> None:
        if self.current or not self._pending or data["test"] != self._pending[0]:
            raise ForgedError("the begin of a test whose turn it is not")
        self.current = self._pending.pop(0)

    def _result(self, data: dict[str, Any]) -> None:
        is_known = data["outcome"] in _OUTCOMES and data["phase"] in _PHASES
        if not self.current or data["test"] != self.current or not is_known:
            raise ForgedError("the result of a test that does not run")
        if data["outcome"] == "passed" and data["message"]:
            data["outcome"] = "failed"  # what failed does not pass because its report says so
        self.current = ""

    def _end(self, data: dict[str, Any]) -> None:
        if self.current or self._pending:
            raise ForgedError("the end before all tests have run")
        self.is_complete = True
