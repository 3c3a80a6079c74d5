"""Programs as processes of their own, for the few tests that need them."""

from __future__ import annotations

import contextlib
import itertools
import os
import select
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

START_S = 60.0
END_S = 20.0
ASLEEP_S = 10.0

_PORTS = range(20_000, 32_000)
"""Below those that systems choose themselves: from 32 768 on, or 49 152."""
_STRIDE = 1009
_taken = itertools.count()


SUITE = "thymio_sim_ros.cli.main"
SERVERS = {"--aseba-port": "--no-aseba", "--tdm-port": "--no-tdm"}
"""Options that switch a server of the suite on, and those that switch it off: many tests run at the same time."""


class Process:
    """`main()` of a module in a process group of its own, with signals reset and its output kept."""

    def __init__(
        self,
        folder: Path,
        module: str,
        *arguments: str,
        prefix: Sequence[str] = (),
        variables: Mapping[str, str] | None = None,
    ) -> None:
        """Start it, with a command in front such as `unshare -n`, and further environment variables.

        A suite has the servers for other programs only if the arguments ask for them.
        """
        if module == SUITE and (not arguments or arguments[0].startswith("--")):
            arguments = (*(off for on, off in SERVERS.items() if on not in arguments), *arguments)
        self._log = folder / f"{module}.txt"
        main = f"import sys; from {module} import main; sys.exit(main())"
        command = [*prefix, sys.executable, "-c", main, *arguments]
        with self._log.open("w") as output:
            self._popen = subprocess.Popen(
                command,
                stdout=output,
                stderr=subprocess.STDOUT,
                start_new_session=True,
                restore_signals=True,
                env={**os.environ, **(variables or {})},
            )

    @property
    def pid(self) -> int:
        """Its process id, and that of its group."""
        return self._popen.pid

    @property
    def output(self) -> str:
        """Everything printed so far."""
        return self._log.read_text()

    @property
    def is_running(self) -> bool:
        """Whether it has not ended yet."""
        return self._popen.poll() is None

    def signal(self, number: int) -> None:
        """Signal the whole group, as a terminal does."""
        os.killpg(self._popen.pid, number)

    def wait(self) -> int:
        """The exit code, at most `END_S` later."""
        return self._popen.wait(END_S)

    def end(self) -> None:
        """End what still runs as a terminal would, so that it can tidy up; by force when it does not."""
        if not self.is_running:
            return
        self.signal(signal.SIGINT)
        try:
            self.wait()
        except subprocess.TimeoutExpired:
            self.signal(signal.SIGKILL)
            self._popen.wait()


def wait_for_port(port: int) -> None:
    """Block until a process listens there; fails after `START_S`."""
    deadline = time.monotonic() + START_S
    while True:
        with socket.socket() as probe:
            probe.settimeout(0.1)
            if probe.connect_ex(("127.0.0.1", port)) == 0:
                return
        assert time.monotonic() < deadline, f"no process listens on port {port}"
        select.select([], [], [], 0.05)


def wait_until_asleep(pid: int) -> None:
    """Return as soon as the main thread of a process waits, before a message can wake it: for Ctrl-C to a node.

    An interrupt while rclpy converts a message becomes a RuntimeError: of 40 nodes that got a thousand messages a
    second one to six, and none after this (measured). A process that does not wait for `ASLEEP_S` is not waited for.
    """
    deadline = time.monotonic() + ASLEEP_S
    with contextlib.suppress(OSError), open(f"/proc/{pid}/stat", "rb", buffering=0) as stat:  # OSError: it has ended
        while b") S " not in os.pread(stat.fileno(), 200, 0) and time.monotonic() < deadline:
            select.select([], [], [], 0.001)


def free_port() -> int:
    """A TCP port of loopback that is free now, and that the system does not give to a process that asks for any port.

    Such a one could go to a server of another test before the program that is to use it has started; processes
    begin to count at places of their own, and take none twice.
    """
    while True:
        port = _PORTS[0] + (os.getpid() * _STRIDE + next(_taken)) % len(_PORTS)
        with socket.socket() as probe:
            try:
                probe.bind(("127.0.0.1", port))
            except OSError:
                continue
        return port
