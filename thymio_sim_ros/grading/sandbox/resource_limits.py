"""Limits of POSIX for a test process and each of its descendants."""

from __future__ import annotations

import os
import resource

from thymio_sim_ros.grading.assignment import Limits

__all__ = ["limit_resources"]

_OPEN_FILES = 512
_NICENESS = 5
"""So that the supervisor gets its turn beside a fork bomb."""
_MARGIN_S = 30
"""Processor time after which the kernel ends a process, should its supervisor not."""


def limit_resources(limits: Limits, other_processes: int) -> None:
    """Limit this process in a session of its own, between fork and exec; it cannot be undone.

    `other_processes`: those of the user that do not belong to the submission, where the kernel counts them too.
    """
    os.setsid()
    os.nice(_NICENESS)
    _limit(resource.RLIMIT_CORE, 0)
    _limit(resource.RLIMIT_CPU, int(limits.total_cpu_s) + _MARGIN_S)
    _limit(resource.RLIMIT_DATA, int(limits.memory_mb * 1e6))  # unlike AS, it leaves out what wasmtime only reserves
    _limit(resource.RLIMIT_FSIZE, int(limits.disk_mb * 1e6))
    _limit(resource.RLIMIT_NOFILE, _OPEN_FILES)
    _limit(resource.RLIMIT_NPROC, limits.processes + other_processes)


def _limit(kind: int, value: int) -> None:
    hard = resource.getrlimit(kind)[1]
    if hard != resource.RLIM_INFINITY:
        value = min(value, hard)
    resource.setrlimit(kind, (value, value))
