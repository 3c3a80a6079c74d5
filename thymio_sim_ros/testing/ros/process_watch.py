"""Watch of a process by its processor time: a busy machine makes no program fail."""

from __future__ import annotations

import os
import re
import subprocess
import time
from collections.abc import Callable
from typing import BinaryIO

from thymio_sim_ros.grading.sandbox.thread_states import is_working
from thymio_sim_ros.lockstep.main import STACKS_SIGNAL

__all__ = ["BLOCKED_S", "ProcessWatch"]

BLOCKED_S = 60.0
"""Last resort: a turn of a program ends the test after so much real time in which no thread wants the processor."""

_STACKS_S = 2.0
"""Longest wait for the stacks of a busy program, in s of real time."""

_IDLE_SHARE = 0.01
"""Processor time that threads of DDS may use in a program that is blocked, as a share of real time."""

_FRAME = re.compile(r'File "(?P<file>.*)", line (?P<line>\d+) in (?P<function>.*)')
_OUR_FRAMES = os.path.join("thymio_sim_ros", "lockstep", "")


class ProcessWatch:
    """The processor time of one process since `begin`."""

    def __init__(self, process: subprocess.Popen[bytes], stacks: BinaryIO) -> None:
        """`stacks`: the file to which the process writes the stacks of its threads on `STACKS_SIGNAL`."""
        self._process = process
        self._stacks = stacks
        self._clock = (~process.pid << 3) | 2  # clock_getcpuclockid(3) of Linux
        self.begin()

    def begin(self) -> None:
        """Begin to count."""
        self._begin_s = self._total_s()
        self._idle_since = time.monotonic()
        self._idle_begin_s = self._begin_s

    def used_s(self) -> float:
        """Processor time of all threads since `begin`, in s."""
        return self._total_s() - self._begin_s

    def is_blocked(self) -> bool:
        """Whether no thread has wanted the processor for `BLOCKED_S` of real time."""
        idle_s = time.monotonic() - self._idle_since
        if is_working(self._process.pid) or self._total_s() - self._idle_begin_s > _IDLE_SHARE * max(idle_s, 1.0):
            self._idle_since, self._idle_begin_s = time.monotonic(), self._total_s()
            return False
        return idle_s > BLOCKED_S

    def place(self) -> str:
        """File, line and function where the running thread of the program is; empty if that cannot be found."""
        begin = self._stacks.seek(0, os.SEEK_END)
        assert STACKS_SIGNAL is not None
        self._process.send_signal(STACKS_SIGNAL)
        self._wait_for(lambda: self._stacks.seek(0, os.SEEK_END) > begin)
        self._process.kill()
        self._process.wait()
        self._stacks.seek(begin)
        return _place(self._stacks.read().decode(errors="replace"))

    def _total_s(self) -> float:
        try:
            return time.clock_gettime(self._clock)
        except OSError:  # it has ended
            return 0.0

    def _wait_for(self, condition: Callable[[], bool]) -> None:
        deadline = time.monotonic() + _STACKS_S
        while not condition() and time.monotonic() < deadline:
            time.sleep(0.01)


def _place(stacks: str) -> str:
    """The innermost frame of the program, in the first thread that does not wait for its turn."""
    for stack in stacks.split("\n\n"):
        frames = [found for line in stack.splitlines() if (found := _FRAME.search(line))]
        if frames and _OUR_FRAMES not in frames[0]["file"]:
            inner = next((frame for frame in frames if "site-packages" not in frame["file"]), frames[0])
            return f"{inner['file']}, line {inner['line']}, in {inner['function']}"
    return ""
