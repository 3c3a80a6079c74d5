"""One test process and its descendants, watched: their report and output are read, and limits are enforced."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.grading.assignment import MAX_FILES, Limits
from thymio_sim_ros.grading.limit_reasons import reason
from thymio_sim_ros.grading.sandbox.pipes import PipeReader, inherited, word
from thymio_sim_ros.grading.sandbox.processes import Processes

__all__ = ["Ended", "LimitError", "WatchedProcess", "disk_use"]

POLL_S = 0.1
_MEMORY_POLLS = 5
"""Polls between two measurements of the memory; one process alone is limited by the kernel."""
_LINE_BYTES = 1_000_000
_KEPT = 20_000
"""Bytes of output that are kept of its begin, and of its end."""
_IDLE_SHARE = 0.01
"""Part of a processor below which a process that waits is idle."""


class LimitError(ThymioSimError):
    """A limit was exceeded; `outcome` is its short name, the text says more."""

    def __init__(self, outcome: str, text: str, *, is_final: bool = False) -> None:
        super().__init__(text)
        self.outcome, self.is_final = outcome, is_final


class Ended(ThymioSimError):  # noqa: N818  (no error of the supervisor)
    """The process has ended; the text is for pupils, `how` is the exit code or signal."""

    def __init__(self, text: str, how: str) -> None:
        super().__init__(text)
        self.how = how


class WatchedProcess:
    """A process with a channel for its report. Invariant: its output never blocks it and never fills the memory."""

    def __init__(
        self,
        command: Sequence[str],
        *,
        folder: Path,
        environment: dict[str, str],
        processes: Processes,
        limits: Limits,
        disk_folder: Path | None,
        ends_at: float,
    ) -> None:
        """Start it in `folder`. `disk_folder`: where the size of its files is measured, None where a file system limits
        it. `ends_at`: `time.monotonic()` of the last resort.
        """
        report, report_child = os.pipe()
        control_child, self._control = os.pipe()
        self._report, self._processes = report, processes
        try:
            self._process = subprocess.Popen(
                [*command, word(report_child), word(control_child)],
                cwd=folder,
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                **inherited((report_child, control_child)),
                **processes.options(),
            )
            processes.started(self._process)
        finally:
            os.close(report_child)
            os.close(control_child)
        assert self._process.stdout is not None
        self._output = self._process.stdout.fileno()
        self._limits, self._disk_folder, self._ends_at = limits, disk_folder, ends_at
        self._pipes = PipeReader(self._report, self._output)
        self._lines = b""
        self._head, self._tail, self._size = b"", b"", 0
        self._polls = 0
        self._test_began_s = processes.used().cpu_s
        self._idle_from = (time.monotonic(), 0.0)

    def send(self, line: str) -> None:
        """Send a line to the process."""
        with contextlib.suppress(OSError):  # it has ended, as `lines` will find
            os.write(self._control, line.encode() + b"\n")

    def lines(self) -> Iterator[bytes]:
        """Yield the lines of its report. Raises Ended or LimitError."""
        next_check = time.monotonic() + POLL_S
        while True:
            self._pipes.wait(max(0.0, next_check - time.monotonic()))
            self._read_output()
            yield from self._read_report()
            if time.monotonic() >= next_check:
                self._check_limits()
                if self._process.poll() is not None:
                    yield from self._read_report()
                    self._read_output()
                    raise _ended(self._process.returncode)
                next_check = time.monotonic() + POLL_S

    def take_output(self) -> tuple[str, float]:
        """Return the output and processor time in s since the last call: of one test."""
        self._read_output()
        total_s = self._processes.used().cpu_s
        cpu_s = total_s - self._test_began_s
        skipped = self._size - len(self._head) - len(self._tail)
        between = f"\n… {skipped} bytes are left out …\n".encode() if skipped else b""
        text = (self._head + between + self._tail).decode("utf-8", "replace")
        self._head, self._tail, self._size = b"", b"", 0
        self._test_began_s = total_s
        self._idle_from = (time.monotonic(), total_s)
        return text, cpu_s

    def last_line(self) -> str:
        """The last line of the output that `take_output` has not returned yet."""
        return (self._head + self._tail).decode("utf-8", "replace").strip().rpartition("\n")[2]

    def close(self) -> None:
        """End it with all its descendants."""
        self._processes.end(self._process)
        self._pipes.close()
        for file in (self._report, self._control):
            os.close(file)
        assert self._process.stdout is not None
        self._process.stdout.close()

    def _read_report(self) -> Iterator[bytes]:
        while chunk := self._pipes.read(self._report):
            self._lines += chunk
            *complete, self._lines = self._lines.split(b"\n")
            yield from complete
            if len(self._lines) > _LINE_BYTES:
                raise LimitError(
                    "output limit", "the program disturbed the report of the tests: remove what writes to it"
                )

    def _read_output(self) -> None:
        while chunk := self._pipes.read(self._output):
            self._size += len(chunk)
            if room := _KEPT - len(self._head):
                self._head, chunk = self._head + chunk[:room], chunk[room:]
            self._tail = (self._tail + chunk)[-_KEPT:]
            if self._size > self._limits.output_mb * 1e6:
                raise LimitError("output limit", reason("output limit", self._limits))

    def _check_limits(self) -> None:
        limits, now = self._limits, time.monotonic()
        memory_limit = int(limits.memory_mb * 1e6)
        self._polls += 1
        if self._polls % _MEMORY_POLLS == 0 and self._processes.memory_used(memory_limit) > memory_limit:
            raise LimitError("memory limit", reason("memory limit", limits))
        usage = self._processes.used()
        if usage.cpu_s > limits.total_cpu_s:
            text = f"the program computed for more than {limits.total_cpu_s:g} s in all tests: look for slow loops"
            raise LimitError("CPU time limit", text, is_final=True)
        if usage.cpu_s - self._test_began_s > limits.cpu_s:
            raise LimitError("CPU time limit", reason("CPU time limit", limits))
        since, cpu_s = self._idle_from
        if usage.is_working or usage.cpu_s - cpu_s > max(0.02, _IDLE_SHARE * (now - since)):
            self._idle_from = (now, usage.cpu_s)
        elif now - since > limits.idle_s:
            raise LimitError("idle limit", reason("idle limit", limits))
        if now > self._ends_at:
            raise LimitError("wall-clock limit", reason("wall-clock limit", limits), is_final=True)
        self.check_disk()

    def check_disk(self) -> None:
        """Raise LimitError for too many files, where no file system limits them."""
        if self._disk_folder is None:
            return
        size, files = disk_use(self._disk_folder)
        if size > self._limits.disk_mb * 1e6 or files > MAX_FILES:
            raise LimitError("disk limit", reason("disk limit", self._limits))


def disk_use(folder: Path) -> tuple[int, int]:
    """Size of all files below a folder in bytes, and number of files and folders."""
    size = files = 0
    for parent, folders, names in os.walk(folder):
        files += len(folders) + len(names)
        for name in names:
            try:
                status = os.lstat(os.path.join(parent, name))
            except OSError:
                continue
            size += status.st_size if sys.platform == "win32" else status.st_blocks * 512
    return size, files


def _ended(code: int) -> Ended:
    if code >= 0:
        text = "the program ended before the test was over: remove what ends it, such as os._exit()"
        return Ended(text, f"the process of the test ended, with exit code {code}")
    name = signal.Signals(-code).name
    text = f"the program crashed or was ended ({name}): find the line with print(), or remove what ends programs"
    return Ended(text, f"the process of the test was ended by {name}")
