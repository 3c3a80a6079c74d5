"""The suite of a pupil as a child process. It ends when the server of the class ends.

On Linux the processes are forked from one that has imported everything (`preload`), so that they start in a fraction of
the time and share its memory. Elsewhere each imports for itself.
"""

from __future__ import annotations

import asyncio
import contextlib
import errno
import multiprocessing
import os
import runpy
import signal
import sys
import threading
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from pathlib import Path

from thymio_sim_ros.access.tokens import READ_ONLY_VARIABLE, TOKEN_VARIABLE
from thymio_sim_ros.bridge.listening import listen
from thymio_sim_ros.classroom.folder import Place

__all__ = [
    "PLAYGROUND_VARIABLE",
    "SuiteOptions",
    "SuiteProcess",
    "command",
    "discovery",
    "environment",
    "free_port",
    "preload",
    "reason_of_end",
]

END_S = 6.0
"""Time until a suite that was asked to end is killed; it ends within 5 s."""
BATCH_TICKS, CLOCK_HZ = 3, 20.0
"""Readings reach programs up to 30 ms later, and a suite takes almost half less of a processor (docs/classroom.md)."""
PLAYGROUND_VARIABLE = "THYMIO_SIM_CLASS_PLAYGROUND"
"""Environment variable of the process from which suites are forked: the playground of the class."""
_LAST_BYTES = 4096
_PROCESSES = (
    multiprocessing.get_context("forkserver") if sys.platform == "linux" else multiprocessing.get_context("spawn")
)
_reaping = threading.Lock()
"""Held while exit codes are read: also a start reads those of other processes, and each can be read once."""


@dataclass(frozen=True, slots=True)
class SuiteOptions:
    """Common options of the suites of a class; a pupil's domain follows from `Place.number`."""

    playground: str
    program: str
    first_domain: int | None = None
    """ROS domain of the first pupil; None: the embedded graph, which has none."""
    has_nodes: bool = False
    """Whether pupils may run ROS nodes that they write on the page."""

    def domain(self, place: Place) -> int | None:
        """ROS domain, None on the embedded graph."""
        return None if self.first_domain is None else self.first_domain + place.number


def free_port() -> int:
    """A port of loopback that is free now. Should another program take it first, the suite starts again on another."""
    sockets = listen("localhost", 0)
    port = int(sockets[0].getsockname()[1])
    for one in sockets:
        one.close()
    return port


def command(options: SuiteOptions, port: int, program: str, parameters: Path) -> list[str]:
    """The arguments of a pupil's suite: all on one port, no tokens, which are in the environment.

    The suite is reached by the router of the class only. `parameters` is a file of ROS parameters with what the pupil
    has made.
    """
    return [
        "--portable" if options.first_domain is None else "--ros",
        *("--address", "localhost", "--trusted-proxy", "127.0.0.1", "--no-aseba", "--no-tdm-ports", "--http"),
        "--nodes" if options.has_nodes else "--no-nodes",
        *("--port", str(port), "--no-foxglove-port"),
        *("--playground", options.playground, "--program", program),
        *("--ros-args", "-p", f"simulator:batch_ticks:={BATCH_TICKS}", "-p", f"simulator:clock_rate:={CLOCK_HZ}"),
        *("--params-file", str(parameters.absolute())),
    ]


def environment(options: SuiteOptions, place: Place, given: Mapping[str, str]) -> dict[str, str]:
    """The environment of a pupil's suite: its tokens and its domain; discovery on this computer unless given."""
    domain = options.domain(place)
    own = {TOKEN_VARIABLE: place.token, READ_ONLY_VARIABLE: place.read_only_token}
    return {**discovery(given), **own, **({} if domain is None else {"ROS_DOMAIN_ID": str(domain)})}


def discovery(given: Mapping[str, str]) -> dict[str, str]:
    """The given variables, with discovery on this computer only unless they say something else."""
    return {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", **given}


def preload(module: str, playground: str = "") -> None:
    """Import a module for all suites that start from now on, where they are forked; it finds the playground's name."""
    os.environ[PLAYGROUND_VARIABLE] = playground
    _PROCESSES.set_forkserver_preload([module])


def reason_of_end(code: int, log: Path) -> str:
    """One line on why a suite has ended: its last error, or its exit code or signal."""
    with contextlib.suppress(OSError), log.open("rb") as file:
        file.seek(max(0, log.stat().st_size - _LAST_BYTES))
        lines = [line.strip() for line in file.read().decode("utf-8", "replace").splitlines()]
        if errors := [line for line in lines if line.startswith("thymio-sim: ") or "Error: " in line]:
            return errors[-1][:300]
    if code < 0:
        with contextlib.suppress(ValueError):
            return f"ended by {signal.Signals(-code).name}"
    return f"ended with exit code {code}"


class SuiteProcess:
    """A running suite; its output is in the file `log`."""

    def __init__(self, arguments: Sequence[str], variables: Mapping[str, str], log: Path) -> None:
        life, self._life = _PROCESSES.Pipe(duplex=False)
        self._process = _PROCESSES.Process(target=_run, args=(arguments, variables, log, life), daemon=True)
        self._log = log
        self._ended = asyncio.Event()

    @classmethod
    async def start(cls, arguments: Sequence[str], variables: Mapping[str, str], log: Path) -> SuiteProcess:
        """Start it. The log of the run before is kept as `<log>.1`."""
        with contextlib.suppress(FileNotFoundError):
            os.replace(log, log.with_name(f"{log.name}.1"))
        with log.open("wb"):
            log.chmod(0o600)  # the suite prints its address with the token
        suite = cls(arguments, variables, log)
        await asyncio.to_thread(suite._start)
        threading.Thread(target=suite._follow, args=(asyncio.get_running_loop(),), daemon=True).start()
        return suite

    @property
    def pid(self) -> int:
        """Its process id."""
        assert self._process.pid is not None
        return self._process.pid

    async def wait(self) -> str:
        """Wait until it has ended; return why."""
        await self._ended.wait()
        return reason_of_end(self._process.exitcode or 0, self._log)

    async def end(self) -> None:
        """End it as Ctrl-C does, by force if it does not end."""
        self._life.close()
        try:
            await asyncio.wait_for(self._ended.wait(), END_S)
        except TimeoutError:
            self.kill()
            await self._ended.wait()

    def kill(self) -> None:
        """End it by force: it does not answer."""
        self._process.kill()

    def _start(self) -> None:
        with _reaping:
            try:
                self._process.start()
            except EOFError as error:
                raise OSError(errno.ECHILD, "the process from which suites are forked has ended") from error

    def _follow(self, loop: asyncio.AbstractEventLoop) -> None:
        wait([self._process.sentinel])
        with _reaping:
            self._process.join()
        with contextlib.suppress(RuntimeError):  # the loop is closed: the class has ended
            loop.call_soon_threadsafe(self._ended.set)


def _run(arguments: Sequence[str], variables: Mapping[str, str], log: Path, life: Connection) -> None:
    """Run `thymio-sim` in the new process until it ends, or until the other end of `life` is closed."""
    if sys.platform != "win32":
        os.setsid()  # Ctrl-C in the terminal is for the server of the class
    with log.open("ab") as file:
        for stream in (1, 2):
            os.dup2(file.fileno(), stream)
    os.environ.clear()
    os.environ.update(variables)
    threading.Thread(target=_end_with, args=(life,), daemon=True).start()
    sys.argv = ["thymio-sim", *arguments]
    runpy.run_module("thymio_sim_ros", run_name="__main__")


def _end_with(life: Connection) -> None:
    with contextlib.suppress(EOFError, OSError):
        life.recv_bytes()
    signal.raise_signal(signal.SIGINT)
