"""Program: a student's program in a process of its own, which has a turn in each tick of simulated time."""

from __future__ import annotations

import contextlib
import json
import os
import select
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from typing import Any

import pytest

from thymio_sim_ros.course_packages import field_checks
from thymio_sim_ros.lockstep.channel import Channel, ClosedError
from thymio_sim_ros.lockstep.main import Options
from thymio_sim_ros.lockstep.real_time import LAST_RESORT_S
from thymio_sim_ros.ros.compat import dds_profile
from thymio_sim_ros.testing.record import SECOND_NS
from thymio_sim_ros.testing.ros.connections import Connection
from thymio_sim_ros.testing.ros.cpu_limit import START_CPU_S
from thymio_sim_ros.testing.ros.process_watch import BLOCKED_S, ProcessWatch

__all__ = ["INTERRUPTED_NS", "OUTPUT_BYTES", "Program"]

INTERRUPTED_NS = 2 * SECOND_NS
"""Simulated time that an interrupted program has for its end."""

_LOOK_S = 0.05
"""Real time between two looks at the processor time."""

_LAST_LINES = 6

OUTPUT_BYTES = 10_000_000
"""Default limit of the output of a program."""

_SHOWN = 20_000
"""Characters of its output, from its end, that the report of the test has."""


class Program:
    """A program under test. Invariant: it runs only in its turns, whose order and times the test determines."""

    def __init__(
        self, title: str, *, check: bool, cpu_limit: float, until: Callable[..., Any], output_limit: int = OUTPUT_BYTES
    ) -> None:
        """`title`: how reports call it; `until`: `Simulation.until`."""
        self.title = title
        self.exit_code: int | None = None
        """None while it runs; negative if a signal ended it."""
        self._check = check
        self._cpu_limit, self._output_limit = cpu_limit, output_limit
        self._until = until
        self._now_ns = 0
        self._lines: list[tuple[int, str]] = []
        self._is_typing_over = False
        self._waits: Sequence[str] = ()
        self._next_ns: int | None = 0
        """Simulated time at which it needs a turn if nothing comes before."""
        self._turns = 0
        self._is_waiting = False
        """Whether it has ended its turn by waiting, not by its end."""
        self._has_shown_errors = False
        self._output = tempfile.TemporaryFile()  # noqa: SIM115  # open as long as the program
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115
        self._stacks = tempfile.TemporaryFile()  # noqa: SIM115

    # --- for the test ---

    @property
    def is_running(self) -> bool:
        """Whether it has not ended."""
        return self.exit_code is None

    @property
    def output(self) -> str:
        """The text that it has written to standard output so far."""
        return _text(self._output)

    @property
    def errors(self) -> str:
        """The text that it has written to standard error so far, with the traceback of its end if there is one."""
        return _text(self._errors)

    def type(self, line: str) -> None:
        """Type a line, which the program can read from its next turn on."""
        self._lines.append((self._now_ns, line + "\n"))

    def wait(self, seconds: float = 60.0) -> int:
        """Let simulated time pass until it has ended, and return its exit code; fails the test after `seconds`."""
        __tracebackhide__ = True
        self._until(lambda: not self.is_running, seconds, what=f"{self.title} has ended")
        assert self.exit_code is not None
        return self.exit_code

    def lines(self) -> list[str]:
        """Describe its state and its last output, one line each."""
        if self.is_running:
            waits = ", ".join(dict.fromkeys(what for what in self._waits if what))
            state = f"runs, waits for {waits}" if waits else "runs"
        else:
            state = f"ended with exit code {self.exit_code} at {self._now_ns / SECOND_NS:.2f} s"
        last = (self.output + self.errors).splitlines()[-_LAST_LINES:]
        return [f"program {self.title}: {state}", *(f"  | {line}" for line in last)]

    # --- for `Programs` ---

    def start(
        self,
        options: Mapping[str, Any],
        connection: Connection,
        *,
        stdin: str | Sequence[tuple[float, str]] | None,
        now_ns: int,
    ) -> None:
        """Start the process: `options` are those of `Options` that are not its files."""
        self._connection, self._now_ns = connection, now_ns
        if stdin is not None:
            timed = [(0.0, line) for line in stdin.splitlines()] if isinstance(stdin, str) else list(stdin)
            self._lines = [(now_ns + round(at * SECOND_NS), line + "\n") for at, line in timed]
            self._is_typing_over = True
        read_fd, to_test = os.pipe()
        from_test, write_fd = os.pipe()
        stacks_fd = self._stacks.fileno()
        given = Options(read_fd=from_test, write_fd=to_test, stacks_fd=stacks_fd, **options)
        command = [sys.executable, "-m", "thymio_sim_ros.lockstep.main", json.dumps(asdict(given))]
        environment = {**os.environ, "PYTHONHASHSEED": "0", "PYTHONUNBUFFERED": "1"}
        field_checks.switch_on(environment)
        with dds_profile.used(dds_profile.ANNOUNCING, environment):
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=self._output,
                stderr=self._errors,
                pass_fds=(from_test, to_test, stacks_fd),
                cwd=given.folder,
                env=environment,
            )
        os.close(from_test)
        os.close(to_test)
        self._channel = Channel(read_fd, write_fd)
        self._watch = ProcessWatch(self._process, self._stacks)

    def take_turn(self, until_ns: int, *, interrupt: bool = False) -> None:
        """Run the program until it waits for `until_ns` or longer; nothing runs if it waits already."""
        __tracebackhide__ = True
        if interrupt or self._is_due(until_ns):
            self._watch.begin()
            self._is_waiting = False
            typed, self._lines = self._lines, []
            message = {
                "now_ns": self._now_ns, "until_ns": until_ns, "lines": typed,
                "is_closed_after": self._is_typing_over, "is_interrupted": interrupt,
            }  # fmt: skip
            message |= self._connection.begin_turn()
            with contextlib.suppress(ClosedError):
                self._run(message)
            self._check_end()
            self._connection.end_turn()
        self._now_ns = max(self._now_ns, until_ns)

    def _is_due(self, until_ns: int) -> bool:
        is_late = self._next_ns is not None and self._next_ns < until_ns
        return is_late or bool(self._lines) or self._connection.has_news

    def _run(self, message: dict[str, Any]) -> None:
        __tracebackhide__ = True
        if not self._turns:
            self._receive()
        self._turns += 1
        self._channel.send(message)
        while (event := self._receive())["event"] != "done":
            if event["event"] == "settle":
                self._channel.send(self._connection.answer())
        self._waits, self._next_ns, self._is_waiting = event["waits"], event["next_ns"], True

    def ask(self, message: dict[str, Any], until: str) -> None:
        """Send a message between turns, and wait for an event."""
        self._is_waiting = False
        with contextlib.suppress(ClosedError):
            self._channel.send(message)
            while self._receive()["event"] != until:
                pass
            self._is_waiting = True
        self._check_end()

    def kill(self) -> None:
        """End the process at once, and close all files."""
        if self.exit_code is None:
            self._process.kill()
            self.exit_code = self._process.wait()
            self._end()

    def close(self) -> None:
        """Print its output, which belongs to the report of the test, and close the files."""
        for words, text in (("printed", self.output), ("reported", "" if self._has_shown_errors else self.errors)):
            if text:
                print(f"--- {self.title} {words}:\n{text[-_SHOWN:]}")
        for file in (self._output, self._errors, self._stacks):
            file.close()

    def _receive(self) -> dict[str, Any]:
        """Wait for a message of the program, as long as it uses no more than its processor time."""
        __tracebackhide__ = True
        limit_s = self._cpu_limit + (START_CPU_S if self._turns <= 1 else 0.0)
        while not select.select([self._channel.read_fd], [], [], _LOOK_S)[0]:
            if self._process.poll() is not None:
                raise ClosedError
            self._check_output()
            if self._watch.used_s() > limit_s:
                self._fail(f"used more than {limit_s:g} s of processor time without a wait")
            if self._watch.is_blocked():
                self._fail(f"waits for something outside the simulation since {BLOCKED_S:g} s of real time")
        event = self._channel.receive()
        self._connection.receive(event)
        return event

    def _end(self) -> None:
        """Release what connects it with the test."""
        self._channel.close()
        self._connection.close()

    def _fail(self, text: str) -> None:
        __tracebackhide__ = True
        place = self._watch.place()
        self.kill()
        where = f"\n  it is at {place}" if place else ""
        pytest.fail("\n".join([f"{self.title} {text}{where}", *self.lines()]))

    def _check_end(self) -> None:
        """Take note of the end of the process unless it waits; an exit code other than 0 fails the test."""
        __tracebackhide__ = True
        if self._is_waiting:
            return
        self.exit_code = self._process.wait(LAST_RESORT_S)
        self._end()
        self._check_output()
        if self._check and self.exit_code:
            self._has_shown_errors = True
            # Its traceback has no room on a full disk either.
            why = "" if os.fstatvfs(self._errors.fileno()).f_bavail else ": the disk is full"
            pytest.fail(f"{self.title} ended with exit code {self.exit_code}{why}\n{self.errors}".rstrip())

    def _check_output(self) -> None:
        __tracebackhide__ = True
        if sum(os.fstat(file.fileno()).st_size for file in (self._output, self._errors)) > self._output_limit:
            self.kill()
            pytest.fail(f"{self.title} printed more than {self._output_limit / 1e6:g} MB")


def _text(file: Any) -> str:
    size = os.fstat(file.fileno()).st_size
    return os.pread(file.fileno(), size, 0).decode(errors="replace")
