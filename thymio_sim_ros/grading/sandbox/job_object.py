"""The processes of a submission in a job object of Windows, which limits and counts them, and ends them together.

https://learn.microsoft.com/windows/win32/procthread/job-objects
"""

from __future__ import annotations

import ctypes
import subprocess
from ctypes import wintypes
from typing import Any

from thymio_sim_ros.grading.assignment import Limits
from thymio_sim_ros.grading.sandbox.processes import Usage

__all__ = ["JobObject"]

_ACCOUNTING, _EXTENDED_LIMITS = 1, 9
_LIMIT_ACTIVE_PROCESSES, _LIMIT_JOB_MEMORY = 0x8, 0x200
_DIE_ON_UNHANDLED_EXCEPTION, _KILL_ON_JOB_CLOSE = 0x400, 0x2000
_BELOW_NORMAL_PRIORITY, _NO_WINDOW = 0x4000, 0x0800_0000
"""Flags of processes that are created."""
_UNIT_S = 1e-7
"""Windows counts time in units of 100 ns."""


class _Accounting(ctypes.Structure):
    """JOBOBJECT_BASIC_ACCOUNTING_INFORMATION."""

    _fields_ = [
        *((name, ctypes.c_int64) for name in ("user", "kernel", "period_user", "period_kernel")),
        *((name, wintypes.DWORD) for name in ("page_faults", "processes", "active", "terminated")),
    ]


class _ExtendedLimits(ctypes.Structure):
    """JOBOBJECT_EXTENDED_LIMIT_INFORMATION."""

    _fields_ = [
        *((name, ctypes.c_int64) for name in ("process_time", "job_time")),
        ("flags", wintypes.DWORD),
        *((name, ctypes.c_size_t) for name in ("least_working_set", "largest_working_set")),
        ("active_processes", wintypes.DWORD),
        ("affinity", ctypes.c_size_t),
        *((name, wintypes.DWORD) for name in ("priority", "scheduling")),
        ("io", ctypes.c_uint64 * 6),
        *((name, ctypes.c_size_t) for name in ("process_memory", "job_memory", "process_peak", "job_peak")),
    ]


class _MemoryCounters(ctypes.Structure):
    """PROCESS_MEMORY_COUNTERS."""

    _fields_ = [
        *((name, wintypes.DWORD) for name in ("size", "page_faults")),
        *((name, ctypes.c_size_t) for name in ("peak", "working_set", "peak_paged", "paged", "peak_unpaged")),
        *((name, ctypes.c_size_t) for name in ("unpaged", "page_file", "peak_page_file")),
    ]


class JobObject:
    """See `processes.Processes`. All processes end with the one that has made the job, whatever ends that one."""

    def __init__(self, limits: Limits | None = None) -> None:
        """Make a job; without limits, it only ends its processes. Raises OSError."""
        self._kernel32 = ctypes.CDLL("kernel32")
        self._kernel32.CreateJobObjectW.restype = wintypes.HANDLE
        self._job = wintypes.HANDLE(self._kernel32.CreateJobObjectW(None, None))
        self._process = wintypes.HANDLE()
        wanted = _ExtendedLimits(flags=_KILL_ON_JOB_CLOSE | _DIE_ON_UNHANDLED_EXCEPTION)
        if limits is not None:
            wanted.flags |= _LIMIT_ACTIVE_PROCESSES | _LIMIT_JOB_MEMORY
            wanted.active_processes, wanted.job_memory = limits.processes, int(limits.memory_mb * 1e6)
        self._check(
            self._kernel32.SetInformationJobObject(
                self._job, _EXTENDED_LIMITS, ctypes.byref(wanted), ctypes.sizeof(wanted)
            )
        )

    def options(self) -> dict[str, Any]:
        """A process below normal priority, without a window."""
        return {"creationflags": _BELOW_NORMAL_PRIORITY | _NO_WINDOW}

    def started(self, process: subprocess.Popen[bytes]) -> None:
        """Add a process to the job: all its descendants will belong to it."""
        self._process = wintypes.HANDLE(int(process._handle))  # type: ignore[attr-defined]  # of Windows
        self._check(self._kernel32.AssignProcessToJobObject(self._job, self._process))

    def used(self) -> Usage:
        """Return what the processes use. Wine does not count for a job, hence the times of the test process."""
        found = _Accounting()
        self._kernel32.QueryInformationJobObject(
            self._job, _ACCOUNTING, ctypes.byref(found), ctypes.sizeof(found), None
        )
        times = (ctypes.c_int64 * 4)()  # creation, exit, kernel, user
        addresses = [ctypes.byref(times, 8 * place) for place in range(4)]
        self._kernel32.GetProcessTimes(self._process, *addresses)
        return Usage(max(found.user + found.kernel, times[2] + times[3]) * _UNIT_S, is_working=False)

    def memory_used(self, limit: int) -> int:
        """Memory of the test process in bytes; Windows itself limits that of all."""
        found = _MemoryCounters(size=ctypes.sizeof(_MemoryCounters))
        self._kernel32.K32GetProcessMemoryInfo(self._process, ctypes.byref(found), found.size)
        return int(found.working_set)

    def end(self, process: subprocess.Popen[bytes]) -> None:
        """End all processes, and reap the test process."""
        self._kernel32.TerminateJobObject(self._job, 1)
        process.wait()

    def _check(self, is_done: int) -> None:
        if not is_done:
            raise OSError(f"Windows refuses a job object: error {self._kernel32.GetLastError()}")
