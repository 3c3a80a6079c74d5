"""A suite of a notebook: its page in a cell, and the kernel as a member of its ROS graph."""

from __future__ import annotations

import contextlib
import html
import importlib.util
import os
import secrets
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from types import TracebackType

from thymio_sim_ros import course_packages
from thymio_sim_ros.access.tokens import TOKEN_VARIABLE
from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.notebook.launcher import ARGUMENTS, START_S
from thymio_sim_ros.portable_ros import import_hook

__all__ = ["Suite", "SuiteError"]

END_S = 6.0
"""Time until a suite that was asked to end is killed."""
_POLL_S = 0.05


class SuiteError(ThymioSimError):
    """The suite has not started."""


class View:
    """The page of a suite, which a notebook shows below the cell."""

    def __init__(self, address: str, height: int) -> None:
        self.address, self.height = address, height

    def _repr_html_(self) -> str:
        address = html.escape(self.address)
        return (
            f'<iframe src="{address}" width="100%" height="{self.height}" allow="autoplay" style="border:0"></iframe>'
        )


class Suite:
    """`thymio-sim` in a process of its own, on an embedded graph, which the nodes of this process join.

    `import rclpy` is served by this package from then on. The suite ends with `close`, with a `with` block, or with
    this process.
    """

    def __init__(self, *arguments: str) -> None:
        """Start it with further arguments of `thymio-sim`, such as `"--playground", "line"`.

        Raises SuiteError with its last lines if it does not start.
        """
        import_hook.install(is_forced=True)
        course_packages.add_to_path()
        from thymio_sim_ros.cli.ros.membership import connected

        self.port = _free_port()
        """The port of its page."""
        self._token = secrets.token_urlsafe(16)
        self._stack = contextlib.ExitStack()
        self._log = Path(self._stack.enter_context(tempfile.TemporaryDirectory(prefix="thymio-sim-"))) / "log.txt"
        try:
            self._process = self._start(arguments)
            self._stack.callback(self._end)
            self._wait()
            url = f"ws://127.0.0.1:{self.port}"
            self._stack.enter_context(connected(url, self._token, "notebook", waits=False))
        except BaseException:
            self._stack.close()
            raise

    @property
    def address(self) -> str:
        """Address of the page with its token; through Jupyter's own server if that has jupyter-server-proxy."""
        base = _proxy_base()
        place = f"http://127.0.0.1:{self.port}/" if base is None else f"{base}proxy/{self.port}/"
        return f"{place}#token={self._token}"

    def view(self, height: int = 600) -> View:
        """Show the page below the cell, `height` in pixels."""
        return View(self.address, height)

    def close(self) -> None:
        """End the suite; a second call has no effect."""
        self._stack.close()

    def __enter__(self) -> Suite:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _start(self, arguments: tuple[str, ...]) -> subprocess.Popen[bytes]:
        own = ["--portable", *ARGUMENTS, "--port", str(self.port)]
        with self._log.open("wb") as output:
            return subprocess.Popen(
                [sys.executable, "-m", "thymio_sim_ros.notebook.child", *own, *arguments],
                stdin=subprocess.PIPE,
                stdout=output,
                stderr=subprocess.STDOUT,
                env=os.environ | {TOKEN_VARIABLE: self._token},
            )

    def _wait(self) -> None:
        """Wait until the port is open. Raises SuiteError."""
        end_s = time.monotonic() + START_S
        while self._process.poll() is None and time.monotonic() < end_s:
            with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", self.port), timeout=_POLL_S):
                return
            time.sleep(_POLL_S)
        lines = self._log.read_text(encoding="utf-8", errors="replace").splitlines()
        raise SuiteError("the suite has not started:\n" + "\n".join(lines[-5:]))

    def _end(self) -> None:
        assert self._process.stdin is not None
        self._process.stdin.close()
        try:
            self._process.wait(END_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


def _free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port: int = server.getsockname()[1]
        return port


def _proxy_base() -> str | None:
    """Path of the Jupyter server of this kernel if it can pass requests on to ports, otherwise None."""
    if importlib.util.find_spec("jupyter_server_proxy") is None:
        return None
    hub = os.environ.get("JUPYTERHUB_SERVICE_PREFIX")
    if hub is not None:
        return hub
    from jupyter_server.serverapp import list_running_servers

    parents = {os.getppid(), int(os.environ.get("JPY_PARENT_PID", "0"))}
    found = {int(server["pid"]): str(server["base_url"]) for server in list_running_servers()}
    return next((base for pid, base in found.items() if pid in parents), None)
