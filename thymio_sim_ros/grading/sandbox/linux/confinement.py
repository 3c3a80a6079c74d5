"""Confinement of a test process: before it runs, it gives up rights of its user and resources beyond the limits."""

from __future__ import annotations

import os
from dataclasses import dataclass

from thymio_sim_ros.grading.assignment import Limits
from thymio_sim_ros.grading.sandbox.linux import landlock, seccomp, syscalls
from thymio_sim_ros.grading.sandbox.resource_limits import limit_resources

__all__ = ["Confinement", "confine"]


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
    limit_resources(confinement.limits, confinement.other_processes)
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
