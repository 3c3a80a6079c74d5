"""The levels of isolation: which of them this machine gives, and the command that starts a sandbox of a level."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from functools import cache

from thymio_sim_ros.grading.assignment import Limits
from thymio_sim_ros.grading.errors import DestroyedError, GradingError
from thymio_sim_ros.grading.sandbox.job import Job, Report
from thymio_sim_ros.grading.sandbox.readable import UNPRIVILEGED_ID, closed_path, needed_paths, python_path

__all__ = ["LEVELS", "best_level", "run_job", "why_unavailable"]

LEVELS: Mapping[str, str] = {
    "namespaces": "own file system, processes and network, by Linux namespaces",
    "landlock": "files of others are closed and TCP is refused, by Landlock; UDP and the list of processes are open",
    "limits": "limits of CPU time, memory, processes and output only; files of your user and the network are OPEN",
    "process": "limits of CPU time, memory and output for a process; your files, programs and the network are OPEN",
}
"""Levels, strongest first, and what they give."""

_IS_LINUX = sys.platform.startswith("linux")

AUTOMATIC = ("namespaces", "landlock") if _IS_LINUX else ("process",)
"""Levels that are chosen without being asked for."""

_LAUNCHER = "thymio_sim_ros.grading.sandbox.launcher"
_GRACE_S = 120.0
"""Real time beyond the last resort after which a sandbox is ended from outside."""


def best_level() -> str:
    """The strongest level that this machine gives. Raises GradingError with the reasons if there is none."""
    reasons = {}
    for level in AUTOMATIC:
        reason = why_unavailable(level)
        if not reason:
            return level
        reasons[level] = reason
    text = "; ".join(f"{level}: {reason}" for level, reason in reasons.items())
    raise GradingError(f"this machine isolates no submissions ({text}); --isolation limits grades without isolation")


def why_unavailable(level: str) -> str:
    """Why a level is not available here; empty if it is. It is tried, not guessed."""
    if level != "process" and not _IS_LINUX:
        return "found no Linux; on Windows use WSL 2"
    if (
        level in ("landlock", "limits")
        and os.geteuid() == 0
        and (reason := _why_closed(needed_paths(), user=UNPRIVILEGED_ID))
    ):
        return reason
    return _probed(level)


@cache
def _probed(level: str) -> str:
    """Why a level cannot run a test here; empty if it can. Tried once in a process."""
    probe = b"def test_nothing(): pass\n"
    job = Job(level, ("test_probe.py",), {"test_probe.py": probe}, {}, None, Limits())
    try:
        report = run_job(job)
    except GradingError as error:
        return str(error)
    return "" if report.collected else report.remark.strip().rpartition("\n")[2]


def _why_closed(paths: Sequence[str], user: int | None) -> str:
    """Why the user of the tests cannot start them with these files of the host; empty if it can.

    A job of root runs as a user without rights. Only in namespaces it has a file system of its own.
    """
    begin = "started by root, tests run as a user without rights, and this user may not use"
    if found := closed_path(paths, user):
        path, closed = found
        part = closed if closed == path else f"{closed}, which leads to {path}"
        return f"{begin} {part}: grade as an ordinary user, or install Python and this package elsewhere, as in /opt"
    if found := closed_path([tempfile.gettempdir()], user):
        return f"{begin} {found[1]}, the place of temporary files: set TMPDIR to a folder that is open to all users"
    return ""


def run_job(job: Job) -> Report:
    """Run a job in a sandbox of its level.

    Raises DestroyedError if the sandbox was ended, GradingError if it cannot be entered or fails by itself.
    """
    limit = job.limits.wall_s + _GRACE_S
    environment = {**os.environ, "PYTHONPATH": python_path(), "PYTHONUTF8": "1"}
    with subprocess.Popen(
        [sys.executable, "-P", "-m", _LAUNCHER],
        # Ctrl-C is for the grader, with which the kernel ends a sandbox; a process without a sandbox has to end itself.
        start_new_session=job.level != "process",
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env=environment,
    ) as process:
        try:
            if sys.platform == "win32":
                _launchers().started(process)
            output, errors = process.communicate(pickle.dumps(job), timeout=limit)
        except subprocess.TimeoutExpired:
            raise DestroyedError(f"the sandbox did not end within {limit:g} s") from None
        finally:
            if job.level == "process":
                process.terminate()  # it ends its processes
            else:
                process.kill()  # with it, the kernel ends its namespaces
    try:
        return Report.from_json(output.decode())
    except ValueError:
        last_line = errors.decode("utf-8", "replace").strip().rpartition("\n")[2]
        kind = DestroyedError if process.returncode < 0 else GradingError
        raise kind(f"the sandbox ended with code {process.returncode}: {last_line or 'no message'}") from None


if sys.platform == "win32":
    from thymio_sim_ros.grading.sandbox.job_object import JobObject

    @cache
    def _launchers() -> JobObject:
        """The job of all sandboxes, which end with this process."""
        return JobObject()
