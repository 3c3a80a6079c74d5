"""Programs as processes of their own, for the few tests that need them."""

from __future__ import annotations

import contextlib
import itertools
import os
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from tests.patience import PATIENCE_S, until

_PORTS = range(20_000, 32_000)
"""Below those that systems choose themselves: from 32 768 on, or 49 152."""
_STRIDE = 1009
_taken = itertools.count()
_REPEAT = 200
"""Turns of the executors of a test, of 5 ms at most, after which a request to a node is repeated."""


PYTHON = os.path.abspath(os.environ.get("THYMIO_TEST_PYTHON") or sys.executable)
"""The Python that runs the programs: another one for tests/platforms."""
SUITE = "thymio_sim_ros.cli.main"
SERVERS = {"--aseba-port": "--no-aseba", "--tdm-port": "--no-tdm"}
"""Options that switch a server of the suite on, and those that switch it off: many tests run at the same time."""

_GROUP: dict[str, Any] = (
    {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP} if sys.platform == "win32" else {"start_new_session": True}
)


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
        command = [*prefix, PYTHON, "-c", main, *arguments]
        with self._log.open("w", encoding="utf-8") as output:
            self._popen = subprocess.Popen(
                command,
                stdout=output,
                stderr=subprocess.STDOUT,
                **_GROUP,
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
        return self._log.read_text(encoding="utf-8", errors="replace")

    @property
    def is_running(self) -> bool:
        """Whether it has not ended yet."""
        return self._popen.poll() is None

    def interrupt(self) -> None:
        """Ask for the end as a terminal does: Ctrl-C, on Windows Ctrl-Break, which a group of processes can get."""
        if sys.platform == "win32":
            self._popen.send_signal(signal.CTRL_BREAK_EVENT)
        else:
            self.signal(signal.SIGINT)

    def signal(self, number: int) -> None:
        """Signal the whole group, as a terminal does."""
        os.killpg(self._popen.pid, number)

    def wait(self) -> int:
        """The exit code, at most `PATIENCE_S` later."""
        return self._popen.wait(PATIENCE_S)

    def end(self) -> None:
        """End what still runs as a terminal would, so that it can tidy up; by force when it does not."""
        if not self.is_running:
            return
        self.interrupt()
        try:
            self.wait()
        except subprocess.TimeoutExpired:
            if sys.platform == "win32":
                self._popen.kill()
            else:
                self.signal(signal.SIGKILL)
            self._popen.wait()


@contextlib.contextmanager
def x_display() -> Iterator[str]:
    """The name of a new X display of 1280 x 900 pixels, for programs with windows; needs Xvfb."""
    names, number = os.pipe()
    with os.fdopen(names) as answer:
        server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(number), "-screen", "0", "1280x900x24"],
            pass_fds=[number],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(number)
        name = f":{answer.readline().strip()}"
    try:
        yield name
    finally:
        server.terminate()
        server.wait()


def wait_for_port(port: int) -> None:
    """Block until a process listens there; fails after `PATIENCE_S`."""

    def listens() -> bool:
        with socket.socket() as probe:
            probe.settimeout(PATIENCE_S)
            return probe.connect_ex(("127.0.0.1", port)) == 0

    until(listens, lambda: f"no process listens on port {port}")


def is_spinning(ros: Any, name: str) -> Callable[[], bool]:
    """Whether a node answers a request for its parameters, which only one that spins does.

    The request is repeated: a service that has not yet found its new client drops the answer.
    """
    from rcl_interfaces.srv import ListParameters

    client = ros.node.create_client(ListParameters, f"/{name}/list_parameters")
    requests: list[Any] = []
    turns = itertools.count()

    def has_answered() -> bool:
        if client.service_is_ready() and next(turns) % _REPEAT == 0:
            requests.append(client.call_async(ListParameters.Request()))
        return any(request.done() for request in requests)

    return has_answered


def wait_until_asleep(pid: int) -> None:
    """Return as soon as the main thread of a process waits, before a message can wake it: for Ctrl-C to a node.

    An interrupt while rclpy converts a message becomes a RuntimeError: of 40 nodes that got a thousand messages a
    second one to six, and none after this (measured). A process that does not wait is interrupted after
    `PATIENCE_S` all the same.
    """
    # OSError: it has ended; AssertionError: it is busy
    with (
        contextlib.suppress(OSError, AssertionError),
        open(f"/proc/{pid}/stat", "rb", buffering=0) as stat,
    ):
        until(lambda: b") S " in os.pread(stat.fileno(), 200, 0), every_s=0.001)


def free_port(count: int = 1) -> int:
    """The first of TCP ports of loopback that are free now, and that the system does not give to others by itself.

    Such a one could go to a server of another test before the program that is to use it has started; processes
    begin to count at places of their own, and take none twice.
    """
    while True:
        turns = [next(_taken) for _ in range(count)]
        first = _PORTS[0] + (os.getpid() * _STRIDE + turns[0]) % (len(_PORTS) - count)
        if all(_is_free(port) for port in range(first, first + count)):
            return first


def _is_free(port: int) -> bool:
    with socket.socket() as probe:
        try:
            probe.bind(("127.0.0.1", port))
        except OSError:
            return False
    return True
