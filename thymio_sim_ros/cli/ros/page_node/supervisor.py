"""The process that supervises a node of the page: isolates it, limits it, passes its output on, and ends it.

Usage: python -m thymio_sim_ros.cli.ros.page_node.supervisor

Its standard input has a job, `go` and `stop`, each a line; its end ends the node with all that it has started. Its
standard output has events as lines of JSON:

{"event": "unavailable", "reason"}   the machine does not give this level of isolation
{"event": "ready"}                   the program begins with `go`
{"event": "output", "text"}
{"event": "ended", "code", "reason"}   reason: the limit that was exceeded, or ""
"""

from __future__ import annotations

import codecs
import contextlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from thymio_sim_ros.access.tokens import TOKEN_VARIABLE
from thymio_sim_ros.cli.ros.page_node.program import READY
from thymio_sim_ros.grading.assignment import MAX_FILES, Limits
from thymio_sim_ros.grading.sandbox.environment import confined_environment
from thymio_sim_ros.grading.sandbox.pipes import PipeReader
from thymio_sim_ros.grading.sandbox.place import Place
from thymio_sim_ros.grading.sandbox.portable_place import PortablePlace
from thymio_sim_ros.grading.sandbox.watched_process import disk_use

__all__ = ["main"]

LIMITS = Limits(memory_mb=500.0, processes=64, disk_mb=16.0, total_cpu_s=1e6)
"""Limits of a node. It may compute as long as it wants, behind all other processes."""
_NICENESS = 5
"""In addition to that of the sandbox: the simulator keeps its pace beside a node that computes without a pause."""
_TURN_S, _TURN_BYTES = 0.1, 16_000
"""At most so many bytes of output are passed on in each turn; a program that prints more waits, as in a terminal."""
_START_TURN_S = 0.01
"""A turn before the program begins, which would wait for it."""
_CHECK_S = 0.5
"""Time between two looks at memory and files."""
_END_S = 1.5
"""Time in which a program that is stopped can end by itself."""
_PROGRAM = "thymio_sim_ros.cli.ros.page_node.program"
_CANNOT_ENTER = 3
_IS_LINUX = sys.platform.startswith("linux")


@dataclass(frozen=True, slots=True)
class Job:
    """A program and where it runs. `level`: one of `grading.sandbox.levels`.

    `link`: number of an inherited socket that is connected with the server, -1 if there is none; then `port` is that of
    the server on loopback.
    """

    level: str
    port: int
    link: int
    token: str
    file: str
    text: str
    arguments: tuple[str, ...]


class _Commands:
    """The lines of the standard input."""

    def __init__(self) -> None:
        self._reader, self._rest = PipeReader(0), b""

    def lines(self) -> Iterator[bytes]:
        """The complete lines that have arrived."""
        while chunk := self._reader.read(0):
            *complete, self._rest = (self._rest + chunk).split(b"\n")
            yield from complete

    def first(self) -> bytes:
        """The first line; empty if there is none."""
        while not self.have_ended:
            self._reader.wait(_CHECK_S)
            for line in self.lines():
                return line
        return b""

    @property
    def have_ended(self) -> bool:
        """Whether the other process has closed the pipe."""
        return self._reader.has_ended(0)


def main() -> int:
    """Supervise the node of the job; return the exit code."""
    # Ctrl-C in the terminal of the suite, which ends this process. Not SIG_IGN, which the program would inherit.
    signal.signal(signal.SIGINT, lambda _number, _frame: None)
    commands = _Commands()
    if not (line := commands.first()):
        return 0
    job = Job(**json.loads(line))
    if hasattr(os, "nice"):
        os.nice(_NICENESS)
    try:
        if not _IS_LINUX:
            with _temporary_folder() as folder:
                _Supervisor(job, PortablePlace(folder, LIMITS), commands).run()
            return 0
        return _run_on_linux(job, commands)
    except OSError as error:
        _say("unavailable", reason=str(error))
        return _CANNOT_ENTER


def _run_on_linux(job: Job, commands: _Commands) -> int:
    from thymio_sim_ros.grading.sandbox.linux import namespaces
    from thymio_sim_ros.grading.sandbox.linux.confinement import Confinement
    from thymio_sim_ros.grading.sandbox.linux.launcher import confinement_of, unprivileged_user
    from thymio_sim_ros.grading.sandbox.linux.place import LinuxPlace

    user = unprivileged_user()

    def supervise(folder: Path, confinement: Confinement, *, is_namespace: bool) -> None:
        place = LinuxPlace(folder, confinement, is_namespace=is_namespace)
        _Supervisor(job, place, commands).run()

    if job.level == "namespaces":
        folder, confinement = Path(namespaces.FOLDER), Confinement(user, LIMITS)
        work = partial(supervise, folder, confinement, is_namespace=True)
        code = namespaces.run_inside(int(LIMITS.disk_mb * 1e6), work)
        if code:
            _say("unavailable", reason="the namespaces cannot be entered")
        return code
    with _temporary_folder() as folder:
        supervise(folder, confinement_of(job.level, folder, LIMITS, user), is_namespace=False)
    return 0


@contextlib.contextmanager
def _temporary_folder() -> Iterator[Path]:
    with tempfile.TemporaryDirectory(prefix="thymio-node-", ignore_cleanup_errors=True) as folder:
        yield Path(folder).resolve()


class _Supervisor:
    """A node from its start to its end. Its output never fills the memory; nothing that it has started is left."""

    def __init__(self, job: Job, place: Place, commands: _Commands) -> None:
        self._job, self._place, self._commands = job, place, commands
        self._decoder = codecs.getincrementaldecoder("utf-8")("replace")
        self._is_ready = self._has_begun = False
        self._ends_at = float("inf")
        """Time at which a program that was stopped is ended."""
        self._next_check = 0.0

    def run(self) -> None:
        """Start the node and follow it until it has ended."""
        os.umask(0o022)
        self._place.begin()
        self._place.prepare({})
        self._place.write({}, {self._job.file: self._job.text.encode()})
        process = self._start()
        assert process.stdout is not None
        output = process.stdout.fileno()
        reader = PipeReader(output)
        try:
            reason = self._follow(process, reader, output)
        finally:
            self._place.processes.end(process)
        self._pass_on(reader.read(output), is_final=True)
        code = process.returncode
        _say("ended", code=code, reason=reason)

    def _start(self) -> subprocess.Popen[bytes]:
        folder, job = self._place.folder, self._job
        environment = confined_environment(folder) | {"PYTHONUNBUFFERED": "1", TOKEN_VARIABLE: job.token}
        url = f"ws://127.0.0.1:{job.port}" if job.link < 0 else "ws://localhost"
        options = self._place.processes.options()
        if job.link >= 0:
            options["pass_fds"] = (job.link,)
        process = subprocess.Popen(
            [sys.executable, "-P", "-m", _PROGRAM, str(job.link), url, job.file, *job.arguments],
            cwd=folder / "work",
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            **options,
        )
        self._place.processes.started(process)
        return process

    def _follow(self, process: subprocess.Popen[bytes], reader: PipeReader, output: int) -> str:
        """Follow it until it ends or must be ended; return the limit that it has exceeded, or ""."""
        while True:
            began_s = time.monotonic()
            self._obey(process)
            left = _TURN_BYTES
            while left > 0 and (chunk := reader.read(output)):
                left -= len(chunk)
                self._pass_on(chunk)
            if process.poll() is not None or self._commands.have_ended or time.monotonic() > self._ends_at:
                return ""
            if began_s >= self._next_check:
                self._next_check = began_s + _CHECK_S
                if reason := self._exceeded():
                    return reason
            turn_s = _TURN_S if self._has_begun else _START_TURN_S
            time.sleep(max(0.0, turn_s - (time.monotonic() - began_s)))

    def _obey(self, process: subprocess.Popen[bytes]) -> None:
        assert process.stdin is not None
        for line in self._commands.lines():
            with contextlib.suppress(OSError):  # it has ended
                if line == b"go":
                    self._has_begun = True
                    process.stdin.write(b"go\n")
                    process.stdin.flush()
                elif self._ends_at == float("inf"):
                    self._ends_at = time.monotonic() + _END_S
                    process.send_signal(signal.SIGINT) if sys.platform != "win32" else process.terminate()

    def _exceeded(self) -> str:
        limit = int(LIMITS.memory_mb * 1e6)
        if self._place.processes.memory_used(limit) > limit:
            return "memory"
        if not self._place.has_own_disk:
            size, files = disk_use(self._place.folder)
            if size > LIMITS.disk_mb * 1e6 or files > MAX_FILES:
                return "disk"
        return ""

    def _pass_on(self, data: bytes, *, is_final: bool = False) -> None:
        if not self._is_ready and READY in data:
            self._is_ready = True
            before, _, data = data.partition(READY)
            self._pass_on(before)
            _say("ready")
        if text := self._decoder.decode(data, is_final):
            _say("output", text=text)


def _say(event: str, **values: object) -> None:
    with contextlib.suppress(OSError):  # the suite has ended
        sys.stdout.buffer.write(json.dumps({"event": event, **values}).encode() + b"\n")
        sys.stdout.buffer.flush()


if __name__ == "__main__":
    sys.exit(main())
