"""A class as a process, and its teacher."""

from __future__ import annotations

import contextlib
import json
import urllib.error
import urllib.request
from collections.abc import Callable
from pathlib import Path
from typing import Any

import psutil

from tests.patience import PATIENCE_S, until
from tests.processes import Process, free_port, wait_for_port

_POLL_S = 0.2


class RunningClass:
    """A class with a folder, on a free port."""

    def __init__(self, path: Path, names: list[str], *, arguments: tuple[str, ...] = ()) -> None:
        port = free_port()
        self.folder, self.port = path / "class", port
        pupils = path / "names.csv"
        pupils.write_text("\n".join(names))
        given = ["--pupils", str(pupils), "--folder", str(self.folder), "--port", str(port)]
        self.process = Process(path, "thymio_sim_ros.cli.main", "class", *given, *arguments)
        wait_for_port(port)

    def token_of(self, pupil: str) -> str:
        """The token of a pupil."""
        return str(next(one["token"] for one in self.known["pupils"] if one["id"] == pupil))

    def bridge_of(self, pupil: str, token: str | None = None) -> str:
        """The address of a pupil's bridge, with the pupil's token unless another one is given."""
        query = f"?token={self.token_of(pupil) if token is None else token}"
        return f"ws://127.0.0.1:{self.port}/p/{pupil}/{query}"

    def end(self) -> None:
        """End the class with all its suites."""
        self.process.end()

    def suite(self, pupil: str) -> psutil.Process:
        """The process of a pupil's suite, as soon as it listens."""
        log = str(self.folder / "pupils" / pupil / "suite.log")
        found: list[psutil.Process] = []

        def is_listening() -> bool:
            found[:] = [one for one in self.suites() if log in _files(one)]
            return bool(found)

        until(is_listening, lambda: f"{self.state()}\n{self.process.output}", every_s=_POLL_S)
        return found[0]

    def suite_port(self, pupil: str) -> int:
        """The port of a pupil's suite on loopback."""
        return min(_listening(self.suite(pupil)))

    def suites(self) -> list[psutil.Process]:
        """The processes of all suites that have opened their ports."""
        return [one for one in psutil.Process(self.process.pid).children(recursive=True) if _listening(one)]

    @property
    def known(self) -> Any:
        """Tokens of the teacher and of the pupils."""
        return json.loads((self.folder / "class.json").read_text())

    @property
    def address(self) -> str:
        """The teacher's page with the token."""
        return f"http://127.0.0.1:{self.port}/teacher/#token={self.known['teacher_token']}"

    def request(self, name: str, fields: Any = None, *, token: str | None = None) -> bytes:
        """The answer to a request of the teacher. Raises HTTPError."""
        given = self.known["teacher_token"] if token is None else token
        request = urllib.request.Request(
            f"http://127.0.0.1:{self.port}/teacher/class/{name}",
            None if fields is None else json.dumps(fields).encode(),
            {"Authorization": f"Bearer {given}"},
        )
        with urllib.request.urlopen(request, timeout=PATIENCE_S) as answer:
            body: bytes = answer.read()
            return body

    def state(self) -> list[Any]:
        """What the teacher's page knows about all pupils."""
        pupils: list[Any] = json.loads(self.request("state"))["pupils"]
        return pupils

    def pupil(self, pupil: str) -> Any:
        """What it knows about one of them."""
        return next(one for one in self.state() if one["id"] == pupil)

    def until(self, pupil: str, condition: Callable[[Any], bool]) -> Any:
        """Wait for a state of a pupil and return it."""
        found: list[Any] = []

        def is_reached() -> bool:
            found[:] = [self.pupil(pupil)]
            return condition(found[0])

        until(is_reached, lambda: f"{found}\n{self.process.output}", every_s=_POLL_S)
        return found[0]


def _listening(process: psutil.Process) -> set[int]:
    with contextlib.suppress(psutil.NoSuchProcess):
        return {one.laddr.port for one in process.net_connections("tcp") if one.status == psutil.CONN_LISTEN}
    return set()


def _files(process: psutil.Process) -> list[str]:
    with contextlib.suppress(psutil.NoSuchProcess):
        return [one.path for one in process.open_files()]
    return []
