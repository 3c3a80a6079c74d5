"""The report of a test process: only the lines that belong there are accepted."""

from __future__ import annotations

import json

import pytest

from thymio_sim_ros.grading.sandbox.report_protocol import ForgedError, ReportProtocol

TESTS = ("a.py::test_1", "a.py::test_2")


def line(do: str, **content: object) -> bytes:
    """A line of a test process that knows the secret."""
    return json.dumps({"secret": "s", "do": do, **content}).encode()


def result(test: str, outcome: str = "passed", message: str = "") -> bytes:
    """The result of a test."""
    return line("result", test=test, outcome=outcome, phase="" if outcome == "passed" else "call", message=message)


COLLECTED = line("collected", tests=[[test, "1"] for test in TESTS], notes=[])
BEGIN = [line("begin", test=test) for test in TESTS]


def test_a_complete_report_is_accepted() -> None:
    protocol = ReportProtocol("s", TESTS)
    lines = [COLLECTED, BEGIN[0], result(TESTS[0]), BEGIN[1], result(TESTS[1], "failed"), line("end")]
    assert [protocol.read(one)[0] for one in lines] == ["collected", "begin", "result", "begin", "result", "end"]
    assert protocol.is_complete


def test_what_passed_with_a_failure_has_failed() -> None:
    protocol = ReportProtocol("s", TESTS)
    for accepted in (COLLECTED, BEGIN[0]):
        protocol.read(accepted)
    assert protocol.read(result(TESTS[0], "passed", "assert False"))[1]["outcome"] == "failed"


@pytest.mark.parametrize(
    "lines",
    [
        [b"no json"],
        [b"{}"],
        [b"[" * 100_000],
        [COLLECTED.replace(b'"s"', b'"t"')],
        [line("collected", tests=[[TESTS[0], "1"]], notes=[])],
        [COLLECTED, COLLECTED],
        [BEGIN[0]],
        [COLLECTED, BEGIN[1]],
        [COLLECTED, result(TESTS[0])],
        [COLLECTED, BEGIN[0], BEGIN[1]],
        [COLLECTED, BEGIN[0], result(TESTS[1])],
        [COLLECTED, BEGIN[0], result(TESTS[0], "perfect")],
        [COLLECTED, BEGIN[0], result(TESTS[0]), result(TESTS[0])],
        [COLLECTED, BEGIN[0], line("result", test=TESTS[0], outcome="passed", phase="before", message="")],
        [COLLECTED, BEGIN[0], line("broken", message="")],
        [COLLECTED, line("end")],
        [line("read")],
        [line("_result")],
    ],
)
def test_a_line_out_of_turn_is_a_forgery(lines: list[bytes]) -> None:
    protocol = ReportProtocol("s", TESTS)
    for accepted in lines[:-1]:
        protocol.read(accepted)
    with pytest.raises(ForgedError):
        protocol.read(lines[-1])
