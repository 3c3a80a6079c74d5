"""Confinement of a test process: before it runs, it gives up rights of its user and resources beyond the limits."""

from __future__ import annotations

import os
import resource
from dataclasses import dataclass

from thymio_sim_ros.grading.assignment import Limits
from thymio_sim_ros.grading.sandbox import landlock, seccomp, syscalls

__all__ = ["Confinement", "confine"]

_OPEN_FILES = 512
_NICENESS = 5
"""So that the supervisor gets its turn beside a fork bomb."""
_MARGIN_S = 30
"""Processor time after which the kernel ends a process, should its supervisor not."""


@dataclass(frozen=True, slots=True)
class Confinement:
    """Confinement of a test process. `user`: the user and group that it becomes, None for the present ones.

    `writable`: the only folders in which it may write, as Landlock enforces; None without Landlock.
    """

    user: int | None
    limits: Limits
    other_processes: int = 0
    """Processes of the user that are not in the sandbox, where the kernel counts them too."""
    writable: tuple[str, ...] | None = None
    readable: tuple[str, ...] = ()
    listable: tuple[str, ...] = ()
    """Folders whose names can be read, where Landlock hides others."""


def confine(confinement: Confinement) -> None:
    """Confine this process, between fork and exec; it cannot be undone."""
    limits = confinement.limits
    os.setsid()
    os.nice(_NICENESS)
    _limit(resource.RLIMIT_CORE, 0)
    _limit(resource.RLIMIT_CPU, int(limits.total_cpu_s) + _MARGIN_S)
    _limit(resource.RLIMIT_DATA, int(limits.memory_mb * 1e6))  # unlike AS, it leaves out what wasmtime only reserves
    _limit(resource.RLIMIT_FSIZE, int(limits.disk_mb * 1e6))
    _limit(resource.RLIMIT_NOFILE, _OPEN_FILES)
    _limit(resource.RLIMIT_NPROC, limits.processes + confinement.other_processes)
    if confinement.user is not None:
        os.setgroups([])
        os.setresgid(confinement.user, confinement.user, confinement.user)
        os.setresuid(confinement.user, confinement.user, confinement.user)
    syscalls.die_with_parent()
    syscalls.drop_capabilities()
    syscalls.forbid_new_privileges()
    if confinement.writable is not None:
        landlock.restrict(confinement.readable, confinement.listable, confinement.writable)
    seccomp.restrict()


def _limit(kind: int, value: int) -> None:
    hard = resource.getrlimit(kind)[1]
    if hard != resource.RLIM_INFINITY:
        value = min(value, hard)
    resource.setrlimit(kind, (value, value))
