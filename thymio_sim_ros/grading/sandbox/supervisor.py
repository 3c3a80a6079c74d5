"""Runs the tests of a job in test processes, and replaces a process that ends, or exceeds a limit, within a test.

The sources of the tests and the submission are never there at the same time: the test process collects the tests, the
supervisor removes their sources, and only then the first test runs. Before each test it writes data and submission
afresh, so that no test finds what another has left or changed.
"""

from __future__ import annotations

import json
import os
import secrets
import stat
import sys
import time
from pathlib import Path
from typing import Any

from thymio_sim_ros.files.test_files import kept_files
from thymio_sim_ros.grading.sandbox.environment import confined_environment
from thymio_sim_ros.grading.sandbox.job import Job, Outcome, Report
from thymio_sim_ros.grading.sandbox.place import Place, write_files
from thymio_sim_ros.grading.sandbox.report_protocol import ForgedError, ReportProtocol
from thymio_sim_ros.grading.sandbox.shown_paths import without_folders
from thymio_sim_ros.grading.sandbox.watched_process import Ended, LimitError, WatchedProcess

__all__ = ["supervise"]

_TEST_PROCESS = "thymio_sim_ros.grading.test_process"
_KEPT_BYTES = 3_000_000
"""Largest file that is kept to explain a failure."""
_INSTEAD = "remove what writes to or closes files that the program has not opened"
_OPEN_FLAGS = os.O_RDONLY | sum(getattr(os, name, 0) for name in ("O_NOFOLLOW", "O_NONBLOCK", "O_BINARY"))


def supervise(job: Job, place: Place) -> Report:
    """Run a job to its end and return the report."""
    os.umask(0o022)
    place.begin()
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
            process.close()
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
            **confined_environment(folder),
            "PYTHONHASHSEED": "0",
            "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1",
        }
        return WatchedProcess(
            [sys.executable, "-P", "-m", _TEST_PROCESS, str(folder / "out"), *self._job.tests],
            folder=work,
            environment=environment,
            processes=self._place.processes,
            limits=self._job.limits,
            disk_folder=None if self._place.has_own_disk else folder,
            ends_at=self._ends_at,
        )

    # --- files ---

    def _prepare_folder(self) -> Path:
        """Empty the folder of the job and write the files of the assignment into it, as the tests are collected."""
        self._place.prepare(self._data)
        work = self._place.folder / "work"
        write_files(work, self._job.assignment)
        return work

    def _write_afresh(self) -> None:
        """Write data and submission, but no file of it whose name is taken. Raises LimitError, ForgedError."""
        taken = self._job.assignment.keys()
        self._place.write(self._data, {name: data for name, data in self._job.submission.items() if name not in taken})

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
                opened = os.open(path, _OPEN_FLAGS)
            except OSError:
                continue
            with os.fdopen(opened, "rb") as file:
                data = file.read(_KEPT_BYTES + 1) if stat.S_ISREG(os.fstat(opened).st_mode) else b""
            if 0 < len(data) <= _KEPT_BYTES:
                files[name] = data
        return files
