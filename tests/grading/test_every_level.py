"""Hostile and faulty submissions at every level of isolation: the same verdicts and reasons, in words for pupils."""

from __future__ import annotations

import os
import sys
from collections.abc import Collection
from fractions import Fraction

import pytest

from thymio_sim_ros.grading import grader
from thymio_sim_ros.grading.assignment import Assignment, Limits
from thymio_sim_ros.grading.results import GradedTest
from thymio_sim_ros.grading.sandbox.levels import LEVELS, why_unavailable
from thymio_sim_ros.grading.submissions import Submission

pytestmark = [
    pytest.mark.process,
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="sandboxes need Linux"),
]

LIMITS = Limits(cpu_s=3, idle_s=3, memory_mb=400, processes=20, output_mb=1, disk_mb=20)
PASSED = ("passed", "")
ENDED = ("crashed", "the program ended before the test was over: remove what ends it, such as os._exit()")


def ends(line: int, kind: str) -> tuple[str, str]:
    """The verdict of a program that ends itself in this line."""
    return "failed", f"answer.py, line {line}: {kind} ends the program before the test is over: remove it"


CASES = {
    "sys.exit(0)": ends(3, "exit()"),
    "raise KeyboardInterrupt": ends(5, "KeyboardInterrupt"),
    "pytest.exit('over', 0)": ends(7, "pytest.exit()"),
    "os._exit(0)": ENDED,
    "os.kill(os.getpid(), 11)": (
        "crashed",
        "the program crashed or was ended (SIGSEGV): find the line with print(), or remove what ends programs",
    ),
    "while True: pass": ("CPU time limit", "the program computed for more than 3 s: look for a loop that never ends"),
    "os.kill(os.getpid(), 19)": (
        "idle limit",
        "the program did nothing for 3 s: look for a sleep, or a wait that never ends",
    ),
    "while True: print('x' * 1000)": (
        "output limit",
        "the program printed more than 1 MB: look for a print() in a loop that never ends",
    ),
    "__import__('numpy').ones(10 ** 9)": (
        "memory limit",
        "the program needed more than 400 MB of memory: look for a list that keeps growing",
    ),
    "os.memfd_create('a')": (
        "memory limit",
        "the program needed more than 400 MB of memory: look for a list that keeps growing",
    ),
    "for i in range(100_000): open(str(i), 'w').close()": (
        "disk limit",
        "the program wrote more than 20 MB or 20000 files: look for a loop that never ends",
    ),
    "os.chmod('.', 0)": PASSED,
    "os.listdir('..')": PASSED,
    "os.unlink('answer.py')": PASSED,
    "import json; j = json.dumps; json.dumps = lambda x, **k: os._exit(0) if x.get('do') == 'begin' else j(x, **k)": (
        "failed",
        "the submission replaced json.dumps, a function of the tests: remove that",
    ),
    "'what the former test has left ends this one'": ENDED,
    "'and no other'": PASSED,
}
"""What a submission does in one test after the other, the verdict, and the first line of its message."""

ELSEWHERE = {"os.memfd_create('a')": PASSED}
"""What differs at the level for other systems than Linux."""

TESTS = """
import runpy
from pathlib import Path

import pytest

@pytest.mark.parametrize("number", range({count}))
def test_it(number):
    runpy.run_path(str(Path(__file__).with_name("answer.py")))[f"answer_{{number}}"]()
"""


def verdicts(level: str, actions: Collection[str]) -> list[tuple[str, str]]:
    """Verdict and first line of the message of a test for each action."""
    if reason := why_unavailable(level):
        pytest.skip(f"{level}: {reason}")
    names = tuple(f"test_it.py::test_it[{number}]" for number in range(len(actions)))
    files = {"test_it.py": TESTS.format(count=len(actions)).encode()}
    assignment = Assignment("it", ("test_it.py",), frozenset(), ("answer.py",), files, LIMITS)
    tests = [GradedTest(name, Fraction(1)) for name in names]
    imports = "import os, pytest, shutil, sys\n"
    answers = [f"def answer_{number}():\n    {action}\n" for number, action in enumerate(actions)]
    submission = Submission("Anna", files={"answer.py": (imports + "".join(answers)).encode()})
    report = grader.run_submission(submission, assignment=assignment, tests=names, level=level)
    graded = grader.graded(submission, tests, report, LIMITS)
    return [(one.outcome, one.message.partition("\n")[0]) for one in graded.verdicts]


@pytest.mark.slow
@pytest.mark.parametrize("level", LEVELS)
def test_verdicts_and_reasons_are_the_same_at_every_level(level: str) -> None:
    expected = CASES | (ELSEWHERE if level == "process" else {})
    assert dict(zip(CASES, verdicts(level, CASES), strict=True)) == expected


@pytest.mark.parametrize("level", LEVELS)
def test_a_submission_that_removes_all_that_it_can_does_the_next_test_no_harm(level: str) -> None:
    if level == "process" or (level == "limits" and os.geteuid()):
        pytest.skip("at this level, a submission has the rights of the user")
    remove = "[shutil.rmtree(os.path.join('..', name), True) for name in os.listdir('..')]"
    assert verdicts(level, [remove, "pass"]) == [PASSED, PASSED]
