"""Limits processor time of code under test in this process: a busy machine makes nothing fail."""

from __future__ import annotations

import contextlib
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from types import FrameType

import pytest

from thymio_sim_ros.testing.ros.interruption import insist, place

__all__ = ["CPU_LIMIT_S", "START_CPU_S", "limited"]

CPU_LIMIT_S = 2.0
"""Default limit of processor time for one callback, or one turn of a program, in s."""

START_CPU_S = 15.0
"""Limit for a constructor, or until a program waits for the first time, in s: it may load modules and data."""

_AGAIN_S = 0.5
"""Processor time after which code that has caught the failure gets it again, in s."""


@contextlib.contextmanager
def limited(what: Callable[[], str], limit_s: float) -> Iterator[None]:
    """Fail the test, with the line, if the code inside uses more than `limit_s` of processor time.

    `what()` names the code. Without effect on other threads than the main one, and on Windows.
    """
    if threading.current_thread() is not threading.main_thread() or not hasattr(signal, "setitimer"):
        yield
        return
    begin_s = time.thread_time()

    def check(_number: int, frame: FrameType | None) -> None:
        rest_s = limit_s - (time.thread_time() - begin_s)
        if rest_s > 0:  # other threads of the process count too
            signal.setitimer(signal.ITIMER_PROF, max(rest_s, 0.01), _AGAIN_S)
            return
        failure = pytest.fail.Exception(
            f"{what()} used more than {limit_s:g} s of processor time without returning{place(frame)}"
        )
        if failures:
            insist(failure, frame)
        failures.append(failure)
        raise failure

    failures: list[BaseException] = []
    trace = sys.gettrace()
    before = signal.signal(signal.SIGPROF, check)
    signal.setitimer(signal.ITIMER_PROF, limit_s, _AGAIN_S)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
        if sys.gettrace() is not trace:
            sys.settrace(trace)
