"""The processes of a submission on a POSIX system that is no Linux, as psutil finds them."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
from functools import partial
from typing import Any

import psutil

from thymio_sim_ros.grading.assignment import Limits
from thymio_sim_ros.grading.sandbox.processes import Usage
from thymio_sim_ros.grading.sandbox.resource_limits import limit_resources

__all__ = ["TrackedProcesses"]

_END_S = 1.0
"""Time between two attempts to end processes."""


class TrackedProcesses:
    """See `processes.Processes`. A process belongs to the submission if its session or an ancestor does.

    A descendant that leaves both, by a session of its own and the end of its parent, is known if it was seen before.
    """

    def __init__(self, limits: Limits) -> None:
        self._limits, self._grader = limits, os.getppid()
        self._cpu_s: dict[psutil.Process, float] = {}
        """Processes with the processor time that each had when it was last seen."""
        self._session = 0

    def options(self) -> dict[str, Any]:
        """A process with limits in a session of its own."""
        user = os.getuid()
        others = sum(1 for other in psutil.process_iter() if _user(other) == user)
        return {"preexec_fn": partial(limit_resources, self._limits, others)}

    def started(self, process: subprocess.Popen[bytes]) -> None:
        """Follow a new test process."""
        self._session = process.pid
        self._cpu_s = {psutil.Process(process.pid): 0.0}

    def used(self) -> Usage:
        """Return what the processes use. Ends this process if the grader has ended."""
        if os.getppid() != self._grader:
            raise SystemExit("the grader has ended")
        for process in self._found():
            with contextlib.suppress(psutil.Error):
                times = process.cpu_times()
                self._cpu_s[process] = times.user + times.system
        return Usage(sum(self._cpu_s.values()), is_working=False)

    def memory_used(self, limit: int) -> int:
        """Memory in bytes; shared pages count once for each process."""
        memory = 0
        for process in self._found():
            with contextlib.suppress(psutil.Error):
                memory += process.memory_info().rss
        return memory

    def end(self, process: subprocess.Popen[bytes]) -> None:
        """End all processes, and reap the test process."""
        while running := [one for one in self._found() if one.pid != process.pid]:
            with contextlib.suppress(OSError):
                os.killpg(self._session, signal.SIGKILL)
            for one in running:
                with contextlib.suppress(psutil.Error):
                    one.kill()
            psutil.wait_procs(running, timeout=_END_S)
        process.kill()
        process.wait()

    def _found(self) -> list[psutil.Process]:
        """The processes that run. New ones are added to the known ones."""
        for pid in psutil.pids():
            with contextlib.suppress(psutil.Error, OSError):
                if os.getsid(pid) == self._session:
                    self._cpu_s.setdefault(psutil.Process(pid), 0.0)
        for known in list(self._cpu_s):
            with contextlib.suppress(psutil.Error):
                for process in known.children(recursive=True):
                    self._cpu_s.setdefault(process, 0.0)
        return [one for one in self._cpu_s if _runs(one)]


def _runs(process: psutil.Process) -> bool:
    try:
        return process.is_running() and process.status() != psutil.STATUS_ZOMBIE
    except psutil.Error:
        return False


def _user(process: psutil.Process) -> int | None:
    try:
        return process.uids().real
    except psutil.Error:
        return None
