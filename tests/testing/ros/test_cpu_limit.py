"""The limit of processor time of code in the test's own process."""

from __future__ import annotations

import contextlib
import sys
import time

import pytest

from thymio_sim_ros.testing.ros.cpu_limit import limited

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no timer of processor time")


def count_for_ever() -> None:
    """A loop that never ends."""
    number = 0
    while True:
        number += 1


def test_a_busy_loop_fails_with_its_line() -> None:
    line = count_for_ever.__code__.co_firstlineno
    with pytest.raises(pytest.fail.Exception) as failed, limited(lambda: "the callback", 0.05):
        count_for_ever()
    head, place = str(failed.value).splitlines()
    assert head == "the callback used more than 0.05 s of processor time without returning"
    assert any(f"test_cpu_limit.py, line {line + there}, in count_for_ever" in place for there in (2, 3, 4))


def catch_for_ever() -> None:
    """A loop that catches everything."""
    while True:
        with contextlib.suppress(BaseException):
            count_for_ever()


def test_code_that_catches_every_failure_ends_too() -> None:
    with pytest.raises(pytest.fail.Exception), limited(lambda: "it", 0.02):
        catch_for_ever()


def test_waiting_uses_no_processor_time() -> None:
    with limited(lambda: "it", 0.05):
        time.sleep(0.1)  # what is under test: real time does not count
