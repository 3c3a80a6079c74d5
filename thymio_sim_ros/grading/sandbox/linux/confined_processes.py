"""The processes of a submission on Linux: those of a namespace, or all descendants of the supervisor."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
from functools import partial
from typing import Any

from thymio_sim_ros.grading.sandbox.linux.confinement import Confinement, confine
from thymio_sim_ros.grading.sandbox.linux.usage import descendants, memory_used, used
from thymio_sim_ros.grading.sandbox.processes import Usage

__all__ = ["ConfinedProcesses"]


class ConfinedProcesses:
    """See `processes.Processes`. The supervisor is the parent of descendants whose parents end."""

    def __init__(self, confinement: Confinement, *, are_alone: bool) -> None:
        """`are_alone`: a kernel namespace has them."""
        self._confinement, self._are_alone = confinement, are_alone

    def options(self) -> dict[str, Any]:
        """A process that gives up its rights."""
        return {"preexec_fn": partial(confine, self._confinement)}

    def started(self, process: subprocess.Popen[bytes]) -> None:
        """Do nothing: it is a descendant."""

    def used(self) -> Usage:
        """Return what the processes use."""
        return used()

    def memory_used(self, limit: int) -> int:
        """Memory in bytes."""
        return memory_used(limit)

    def end(self, process: subprocess.Popen[bytes]) -> None:
        """End all processes, and reap the test process."""
        while descendants():
            self._kill()
            process.poll()
            _reap()

    def _kill(self) -> None:
        if self._are_alone:
            with contextlib.suppress(ProcessLookupError):
                os.kill(-1, signal.SIGKILL)  # all of the namespace but this one
            return
        stopped: set[int] = set()
        while new := {process.pid for process in descendants()} - stopped:  # those that fork are stopped first
            _signal(new, signal.SIGSTOP)
            stopped |= new
        _signal(stopped, signal.SIGKILL)


def _signal(processes: set[int], number: signal.Signals) -> None:
    for process in processes:
        with contextlib.suppress(ProcessLookupError):
            os.kill(process, number)


def _reap() -> None:
    """Wait for an end among the descendants that this process has inherited, and reap those that have ended."""
    try:
        os.waitpid(-1, 0)
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass
    except ChildProcessError:
        pass
