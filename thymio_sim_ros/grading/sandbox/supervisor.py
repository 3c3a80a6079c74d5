"""Runs the tests of a job in test processes, and replaces a process that ends, or exceeds a limit, within a test.

The sources of the tests and the submission are never there at the same time: the test process collects the tests, the
supervisor removes their sources, and only then the first test runs. Before each test it writes data and submission
afresh, so that no test finds what another has left or changed.
"""

from __future__ import annotations

import contextlib
import errno
import json
import os
import secrets
import shutil
import signal
import sys
import time
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from thymio_sim_ros.files.test_files import kept_files
from thymio_sim_ros.grading.sandbox import namespaces, syscalls
from thymio_sim_ros.grading.sandbox.confinement import Confinement, confine
from thymio_sim_ros.grading.sandbox.job import Job, Outcome, Report
from thymio_sim_ros.grading.sandbox.readable import python_path, readable_paths
from thymio_sim_ros.grading.sandbox.report_protocol import ForgedError, ReportProtocol
from thymio_sim_ros.grading.sandbox.shown_paths import without_folders
from thymio_sim_ros.grading.sandbox.usage import descendants
from thymio_sim_ros.grading.sandbox.watched_process import Ended, LimitError, WatchedProcess

__all__ = ["Place", "supervise"]

_TEST_PROCESS = "thymio_sim_ros.grading.test_process"
_KEPT_BYTES = 3_000_000
"""Largest file that is kept to explain a failure."""
_INSTEAD = "remove what writes to or closes files that the program has not opened"
_FULL, _NOT_WRITTEN = 3, 4
"""Exit codes of the process that writes the files of a test."""
_ENVIRONMENT = ("LD_LIBRARY_PATH", "AMENT_PREFIX_PATH", "ROS_DISTRO", "RMW_IMPLEMENTATION")


@dataclass(frozen=True, slots=True)
class Place:
    """Place of a job: its writable folder, its confinement, and whether a kernel namespace has its processes."""

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
    report = Report(supervisor.outcomes, supervisor.collected, supervisor.remark, supervisor.notes)
    return without_folders(report, place.folder)


class _Supervisor:
    """The state of a job. Invariant: `outcomes` has the tests that have ended."""

    def __init__(self, job: Job, place: Place) -> None:
        self._job, self._place = job, place
        self._ends_at = time.monotonic() + job.limits.wall_s
        self._data = {name: data for name, data in job.assignment.items() if not name.endswith(".py")}
        self._bound: list[Path] = []
        """Files of the assignment that are mounted read-only beside those of the submission."""
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
        task: dict[str, Any] = {
            "secret": secret,
            "selected": selected,
            "assignment": str(self._place.folder / "assignment"),
        }
        task |= {"handed_in": self._job.handed_in, "output_bytes": int(self._job.limits.output_mb * 1e6)}
        task["has_installed_ros"] = self._job.has_installed_ros
        process.send(json.dumps(task))
        try:
            return self._follow(process, protocol, work)
        except ForgedError as error:
            self.remark = f"the report of the tests was manipulated ({error}): {_INSTEAD}"
        except (Ended, LimitError) as error:
            outcome = error.outcome if isinstance(error, LimitError) else "crashed"
            if protocol.current or self.outcomes:
                # Between two tests, what a former one has left costs the next one.
                test = next((test for test in selected or () if test not in self.outcomes), "")
                if test:
                    self._end_test(process, test, outcome, str(error))
                return bool(test) and not (isinstance(error, LimitError) and error.is_final)
            last_line = process.last_line()
            how = f"{outcome} before the first test: {error}"
            self.remark = f"stopped before the first test: {error.how}" if isinstance(error, Ended) else how
            self.notes = (last_line,) if last_line else ()
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
                process.take_output()
                self._write_afresh()
                process.send("go")
            elif kind == "begin":
                self._write_afresh()
                process.send("go")
            elif kind == "result":
                process.check_disk()
                self._end_test(process, str(data["test"]), str(data["outcome"]), str(data["message"]), data["phase"])
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
        """Empty the folder of the job and write the files of the assignment into it, as the tests are collected."""
        self._unbind()
        user = self._place.confinement.user
        for name in ("tmp", "out", "work"):
            path = self._place.folder / name
            _remove(path)
            path.mkdir()
            if user is not None:
                os.chown(path, user, user)
        if self._place.has_own_disk:
            _empty(Path("/dev/shm"))
            _empty(Path("/tmp"), keep={Path(path).parts[:3] for path in readable_paths()})
        self._write_assignment()
        work = self._place.folder / "work"
        _write(work, self._job.assignment)
        return work

    def _write_assignment(self) -> None:
        """Write the data of the assignment where no submission can change them, if the level gives such a place."""
        folder = self._place.folder / "assignment"
        has_landlock = self._place.confinement.writable is not None
        if (self._place.has_own_disk or has_landlock) and folder.exists():  # a rule of Landlock holds for this folder
            return
        _remove(folder)
        folder.mkdir()
        _write(folder, self._data)
        if self._place.has_own_disk:
            namespaces.bind_read_only(folder, folder)

    def _write_afresh(self) -> None:
        """Write data and submission, but no file of the submission whose name is taken. Raises LimitError, ForgedError.

        Processes of the submission may run and change paths meanwhile. Therefore the process that writes has no more
        rights than they have, so that they cannot make it write to places that are closed to them.
        """
        self._unbind()
        if not self._place.has_own_disk:
            self._write_assignment()
        work, taken = self._place.folder / "work", self._job.assignment.keys()
        submission = {name: data for name, data in self._job.submission.items() if name not in taken}
        writer = os.fork()
        if writer == 0:
            try:
                confine(self._place.confinement)
                _empty(work)
                _write(work, {**self._data, **submission})
                os._exit(0)
            except OSError as error:
                os._exit(_FULL if error.errno in (errno.ENOSPC, errno.EDQUOT) else _NOT_WRITTEN)
            except BaseException:
                os._exit(_NOT_WRITTEN)
        code = os.waitstatus_to_exitcode(os.waitpid(writer, 0)[1])
        if code == _FULL:
            raise LimitError(
                "disk limit", "the files of the program leave no room for the next test: write less, or delete files"
            )
        try:
            if code:
                raise OSError(f"exit code {code}")
            for name in self._data if self._place.has_own_disk else ():
                namespaces.bind_read_only(self._place.folder / "assignment" / name, work / name)
                self._bound.append(work / name)
        except OSError as error:
            raise ForgedError("files of the assignment that could not be written") from error

    def _unbind(self) -> None:
        while self._bound:
            with contextlib.suppress(OSError):
                syscalls.umount(str(self._bound.pop()))

    def _end_test(self, process: WatchedProcess, test: str, outcome: str, message: str, phase: str = "") -> None:
        try:
            output, cpu_s = process.take_output()
        except LimitError as error:
            outcome, message, output, cpu_s, phase = error.outcome, str(error), "", 0.0, ""
        files = {} if outcome == "passed" else self._kept_files(test)
        self.outcomes[test] = Outcome(outcome, message, output, round(cpu_s, 2), files, phase)

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


def _write(folder: Path, files: Mapping[str, bytes]) -> None:
    for name, data in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(data)


def _empty(folder: Path, keep: Collection[tuple[str, ...]] = ()) -> None:
    """Remove all that a folder has, but for paths with these parts, where files of the system are mounted."""
    folder.chmod(folder.stat().st_mode | 0o700)
    for path in folder.iterdir():
        if path.parts in keep:
            continue
        if path.is_dir() and not path.is_symlink():
            _remove(path)
        else:
            path.unlink()


def _remove(folder: Path) -> None:
    """Remove a folder with all that a submission has left in it, also folders that it has closed."""
    if folder.is_symlink():  # a submission has put it there
        folder.unlink()
    elif folder.is_dir():
        for parent, folders, _ in os.walk(folder):
            for name in folders:
                path = os.path.join(parent, name)
                if not os.path.islink(path):
                    os.chmod(path, 0o700)
        folder.chmod(0o700)
        shutil.rmtree(folder)
