"""Runs a job at the levels of isolation of Linux."""

from __future__ import annotations

import os
import tempfile
from functools import partial
from pathlib import Path

from thymio_sim_ros.grading.assignment import Limits
from thymio_sim_ros.grading.sandbox.job import Job
from thymio_sim_ros.grading.sandbox.linux import namespaces, syscalls
from thymio_sim_ros.grading.sandbox.linux.confinement import Confinement
from thymio_sim_ros.grading.sandbox.linux.place import LinuxPlace
from thymio_sim_ros.grading.sandbox.place import FOLDERS
from thymio_sim_ros.grading.sandbox.readable import PACKAGE_FOLDER, UNPRIVILEGED_ID, readable_paths
from thymio_sim_ros.grading.sandbox.supervisor import supervise

__all__ = ["confinement_of", "run", "unprivileged_user"]

_FIRST_USER = 1_800_000_000


def run(job: Job) -> int:
    """Run a job and print the report; return the exit code."""
    syscalls.die_with_parent()
    user = unprivileged_user()
    if job.level == "namespaces":
        return namespaces.run_inside(int(job.limits.disk_mb * 1e6), partial(_run_in_namespaces, job, user))
    with tempfile.TemporaryDirectory(prefix="thymio-grade-", ignore_cleanup_errors=True) as folder:
        confinement = confinement_of(job.level, Path(folder), job.limits, user)
        _print(job, LinuxPlace(Path(folder), confinement, is_namespace=False))
    return 0


def confinement_of(level: str, folder: Path, limits: Limits, user: int | None) -> Confinement:
    """The confinement of a process in a folder of the host, at a level without namespaces."""
    if user is not None:
        os.chown(folder, -1, user)
        folder.chmod(0o750)  # its folders cannot be removed or renamed
    has_landlock = level == "landlock"
    return Confinement(
        user,
        limits,
        0 if user is not None else _threads_of_user(),
        tuple(f"{folder}/{name}" for name in FOLDERS) if has_landlock else None,
        (*readable_paths(), f"{folder}/assignment") if has_landlock else (),
        (str(PACKAGE_FOLDER), str(folder)) if has_landlock else (),
    )


def _run_in_namespaces(job: Job, user: int | None) -> None:
    place = LinuxPlace(Path(namespaces.FOLDER), Confinement(user, job.limits), is_namespace=True)
    _print(job, place)


def _print(job: Job, place: LinuxPlace) -> None:
    print(supervise(job, place).to_json(), flush=True)


def unprivileged_user() -> int | None:
    """A user of its own for a process that root starts; None for any other user, who cannot become another."""
    if os.geteuid() != 0:
        return None
    wanted = _FIRST_USER + os.getpid()
    ranges = [tuple(map(int, line.split())) for line in Path("/proc/self/uid_map").read_text("ascii").splitlines()]
    return wanted if any(first <= wanted < first + count for first, _, count in ranges) else UNPRIVILEGED_ID


def _threads_of_user() -> int:
    """Number of processes and threads of this user, which the kernel counts with those of the sandbox."""
    count = 0
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            if os.stat(f"/proc/{name}").st_uid == os.geteuid():
                count += len(os.listdir(f"/proc/{name}/task"))
        except OSError:
            continue
    return count
