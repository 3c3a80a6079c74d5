"""The suite of a pupil as a child process in a session of its own. It ends when the server of the class ends."""

from __future__ import annotations

import asyncio
import contextlib
import ctypes
import os
import signal
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from thymio_sim_ros.bridge.access import READ_ONLY_VARIABLE, TOKEN_VARIABLE
from thymio_sim_ros.classroom.folder import Place

__all__ = ["SuiteOptions", "SuiteProcess", "command", "discovery", "environment", "reason_of_end"]

END_S = 6.0
"""Time until a suite that was asked to end is killed; it ends within 5 s."""
BATCH_TICKS, CLOCK_HZ = 3, 20.0
"""Readings reach programs up to 30 ms later, and a suite takes almost half less of a processor (docs/classroom.md)."""
_PR_SET_PDEATHSIG = 1
_LAST_BYTES = 4096
_LIBC = ctypes.CDLL(None, use_errno=True) if sys.platform == "linux" else None


@dataclass(frozen=True, slots=True)
class SuiteOptions:
    """Common options of the suites of a class; a pupil's ports and domain follow from `Place.number`."""

    address: str
    first_port: int
    first_domain: int
    playground: str
    program: str

    def port(self, place: Place) -> int:
        """Port of the page; that of the bridge is the next one. The first port is that of the teacher's page."""
        return self.first_port + 1 + 2 * place.number

    def foxglove_port(self, place: Place) -> int:
        """Port of the bridge."""
        return self.port(place) + 1

    def domain(self, place: Place) -> int:
        """ROS domain."""
        return self.first_domain + place.number


def command(options: SuiteOptions, place: Place, program: str, parameters: Path) -> list[str]:
    """The command line of a pupil's suite: no servers for other programs, no tokens, which others could read.

    `parameters` is a file of ROS parameters with what the pupil has made.
    """
    ports = ["--port", str(options.port(place)), "--foxglove-port", str(options.foxglove_port(place))]
    world = ["--playground", options.playground, "--program", program]
    return [
        *(sys.executable, "-m", "thymio_sim_ros", "--address", options.address, "--no-aseba", "--no-tdm"),
        *ports,
        *world,
        *("--ros-args", "-p", f"simulator:batch_ticks:={BATCH_TICKS}", "-p", f"simulator:clock_rate:={CLOCK_HZ}"),
        *("--params-file", str(parameters.absolute())),
    ]


def environment(options: SuiteOptions, place: Place, given: Mapping[str, str]) -> dict[str, str]:
    """The environment of a pupil's suite: its tokens and its domain; discovery on this computer unless given."""
    own = {
        TOKEN_VARIABLE: place.token,
        READ_ONLY_VARIABLE: place.read_only_token,
        "ROS_DOMAIN_ID": str(options.domain(place)),
    }
    return {**discovery(given), **own}


def discovery(given: Mapping[str, str]) -> dict[str, str]:
    """The given variables, with discovery on this computer only unless they say something else."""
    return {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", **given}


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

    def __init__(self, process: asyncio.subprocess.Process, log: Path) -> None:
        self._process = process
        self._log = log

    @classmethod
    async def start(cls, arguments: list[str], variables: Mapping[str, str], log: Path) -> SuiteProcess:
        """Start it. The log of the run before is kept as `<log>.1`."""
        with contextlib.suppress(FileNotFoundError):
            os.replace(log, log.with_name(f"{log.name}.1"))
        with log.open("wb") as output:
            log.chmod(0o600)  # the suite prints its address with the token
            process = await asyncio.create_subprocess_exec(
                *arguments,
                env=dict(variables),
                stdin=asyncio.subprocess.DEVNULL,
                stdout=output,
                stderr=output,
                start_new_session=True,
                preexec_fn=_end_with_parent,
            )
        return cls(process, log)

    @property
    def pid(self) -> int:
        """Its process id."""
        return self._process.pid

    async def wait(self) -> str:
        """Wait until it has ended; return why."""
        return reason_of_end(await self._process.wait(), self._log)

    async def end(self) -> None:
        """End it as Ctrl-C does, by force if it does not end."""
        if self._process.returncode is not None:
            return
        self._signal(signal.SIGINT)
        try:
            await asyncio.wait_for(self._process.wait(), END_S)
        except TimeoutError:
            self._signal(signal.SIGKILL)
            await self._process.wait()

    def kill(self) -> None:
        """End it by force: it does not answer."""
        self._signal(signal.SIGKILL)

    def _signal(self, number: signal.Signals) -> None:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self._process.pid, number)


def _end_with_parent() -> None:
    """In the child: be ended by the kernel when the server of the class is killed. Linux only."""
    if _LIBC is not None:
        _LIBC.prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
