"""Runs the tests of a job in test processes, and replaces a process that ends, or exceeds a limit, within a test.

The files of the tests and of the submission are never there at the same time: the test process collects the tests, the
supervisor removes their sources and writes the submission, and only then the first test runs.
"""

from __future__ import annotations

import contextlib
import json
import os
import secrets
import shutil
import signal
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from thymio_sim_ros.grading.sandbox import syscalls
from thymio_sim_ros.grading.sandbox.confinement import Confinement, confine
from thymio_sim_ros.grading.sandbox.job import Job, Outcome, Report
from thymio_sim_ros.grading.sandbox.readable import python_path
from thymio_sim_ros.grading.sandbox.report_protocol import ForgedError, ReportProtocol
from thymio_sim_ros.grading.sandbox.usage import descendants
from thymio_sim_ros.grading.sandbox.watched_process import Ended, LimitError, WatchedProcess
from thymio_sim_ros.runlog.test_files import kept_files

__all__ = ["Place", "supervise"]

_TEST_PROCESS = "thymio_sim_ros.grading.test_process"
_KEPT_BYTES = 3_000_000
"""Largest file that is kept to explain a failure."""
_ENVIRONMENT = ("LD_LIBRARY_PATH", "AMENT_PREFIX_PATH", "ROS_DISTRO", "RMW_IMPLEMENTATION")


@dataclass(frozen=True, slots=True)
class Place:
    """Where a job runs: its writable folder, how it is confined, and whether a kernel namespace has its processes."""

    folder: Path
    confinement: Confinement
    has_own_processes: bool
    has_own_disk: bool


def supervise(job: Job, place: Place) -> Report:
    """Run a job to its end and return the report."""
    os.umask(0o022)
    if place.has_own_processes:
        signal.signal(signal.SIGINT, signal.SIG_DFL)  # the first process of a namespace ignores what it does not handle
    syscalls.hide_memory()
    syscalls.reap_orphans()
    supervisor = _Supervisor(job, place)
    supervisor.run()
    return Report(supervisor.outcomes, supervisor.collected, supervisor.remark, supervisor.notes)


class _Supervisor:
    """The state of a job. Invariant: `outcomes` has the tests that have ended."""

    def __init__(self, job: Job, place: Place) -> None:
        self._job, self._place = job, place
        self._ends_at = time.monotonic() + job.limits.wall_s
        self.outcomes: dict[str, Outcome] = {}
        self.collected: tuple[tuple[str, str], ...] = ()
        self.remark = ""
        self.notes: tuple[str, ...] = ()

    def run(self) -> None:
        remaining = self._job.selected
        while remaining is None or remaining:
            if not self._run_process(remaining) or remaining is None:
                return
            remaining = tuple(test for test in remaining if test not in self.outcomes)

    def _run_process(self, selected: tuple[str, ...] | None) -> bool:
        """Run tests in a new process; return whether others may follow in another one."""
        work = self._prepare_folder()
        protocol = ReportProtocol(secret := secrets.token_hex(16), selected)
        process = self._start(work)
        process.send(json.dumps({"secret": secret, "selected": selected}))
        try:
            return self._follow(process, protocol, work)
        except ForgedError as error:
            self.remark = f"the report of the tests was manipulated: {error}"
        except (Ended, LimitError) as error:
            is_limit = isinstance(error, LimitError)
            outcome = error.outcome if isinstance(error, LimitError) else "crashed"
            if protocol.current:
                self._end_test(process, protocol.current, outcome, str(error))
                return not (isinstance(error, LimitError) and error.is_final)
            where = "before the first test" if protocol.collected is None or not self.outcomes else "between two tests"
            said = process.last_line()
            self.remark = f"{outcome if is_limit else 'stopped'} {where}: {error}" + (f": {said}" if said else "")
        finally:
            process.close(self._kill_all)
        return False

    def _follow(self, process: WatchedProcess, protocol: ReportProtocol, work: Path) -> bool:
        for line in process.lines():
            kind, data = protocol.read(line)
            if kind == "broken":
                self.remark = protocol.notes[0]
                return False
            if kind == "collected":
                self.collected, self.notes = protocol.collected or (), protocol.notes
                if self._job.selected is None:
                    return False
                self._replace_tests_by_submission(work)
                process.take_output()
                process.send("go")
            elif kind == "result":
                self._end_test(process, str(data["test"]), str(data["outcome"]), str(data["message"]))
            elif kind == "end":
                return True
        raise AssertionError("a process has ended without an exception")

    def _start(self, work: Path) -> WatchedProcess:
        folder = self._place.folder
        environment = {
            "PATH": "/usr/local/bin:/usr/bin:/bin",
            "HOME": str(folder / "tmp"),
            "TMPDIR": str(folder / "tmp"),
            "LANG": "C.UTF-8",
            "PYTHONPATH": python_path(),
            "PYTHONHASHSEED": "0",
            "PYTHONDONTWRITEBYTECODE": "1",
            "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1",
            "OPENBLAS_NUM_THREADS": "1",
            **{name: os.environ[name] for name in _ENVIRONMENT if name in os.environ},
        }
        return WatchedProcess(
            [sys.executable, "-P", "-m", _TEST_PROCESS, str(folder / "out"), *self._job.tests],
            folder=work,
            environment=environment,
            confine=partial(confine, self._place.confinement),
            limits=self._job.limits,
            disk_folder=None if self._place.has_own_disk else folder,
            ends_at=self._ends_at,
        )

    # --- files ---

    def _prepare_folder(self) -> Path:
        """Empty the folder of the job and write the files of the assignment into it."""
        for name in ("tmp", "out", "work"):
            path = self._place.folder / name
            _remove(path)
            path.mkdir()
            self._give(path)
        work = self._place.folder / "work"
        self._write(work, self._job.assignment)
        return work

    def _replace_tests_by_submission(self, work: Path) -> None:
        """Remove the Python files of the assignment, then write the submission, but no file whose name is taken."""
        for name in self._job.assignment:
            if name.endswith(".py"):
                (work / name).unlink()
        taken = self._job.assignment.keys()
        self._write(work, {name: data for name, data in self._job.submission.items() if name not in taken})

    def _write(self, folder: Path, files: Mapping[str, bytes]) -> None:
        for name, data in files.items():
            path = folder / name
            for parent in reversed(path.relative_to(folder).parents[:-1]):
                (folder / parent).mkdir(exist_ok=True)
                self._give(folder / parent)
            path.write_bytes(data)
            self._give(path)

    def _give(self, path: Path) -> None:
        user = self._place.confinement.user
        if user is not None:
            os.chown(path, user, user)

    def _end_test(self, process: WatchedProcess, test: str, outcome: str, message: str) -> None:
        try:
            output, cpu_s = process.take_output()
        except LimitError as error:
            outcome, message, output, cpu_s = error.outcome, str(error), "", 0.0
        files = {} if outcome == "passed" else self._kept_files(test)
        self.outcomes[test] = Outcome(outcome, message, output, round(cpu_s, 2), files)

    def _kept_files(self, test: str) -> dict[str, bytes]:
        """Files of the test process that explain a failure. They may be anything: links and large ones are left out."""
        files = {}
        for name, path in kept_files(self._place.folder / "out", test).items():
            try:
                opened = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
            except OSError:
                continue
            with os.fdopen(opened, "rb") as file:
                data = file.read(_KEPT_BYTES + 1) if os.path.isfile(f"/proc/self/fd/{opened}") else b""
            if 0 < len(data) <= _KEPT_BYTES:
                files[name] = data
        return files

    # --- processes ---

    def _kill_all(self) -> None:
        if self._place.has_own_processes:
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


def _remove(folder: Path) -> None:
    """Remove a folder with all that a submission has left in it, also folders that it has closed."""
    if folder.is_dir():
        for parent, folders, _ in os.walk(folder):
            for name in folders:
                path = os.path.join(parent, name)
                if not os.path.islink(path):
                    os.chmod(path, 0o700)
        folder.chmod(0o700)
        shutil.rmtree(folder)
