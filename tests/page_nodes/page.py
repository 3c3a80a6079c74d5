"""A page that runs nodes, as a client of a suite."""

from __future__ import annotations

import json
from types import TracebackType
from typing import Any

from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

from tests.patience import PATIENCE_S

__all__ = ["Page"]


class Page:
    """The WebSocket of a page of a suite at a port, or at an address with a path, `where`."""

    def __init__(
        self, port: int, where: str = "localhost", *, token: str = "", origin: str | None = None, **headers: str
    ):
        name, _, path = where.partition("/")
        host = f"{name}:{port}"
        offered = [Subprotocol("page-node"), *([Subprotocol(f"token.{token}")] if token else [])]
        self._connecting = connect(
            f"ws://{host}/{path}page-node",
            subprotocols=offered,
            origin=f"http://{host}" if origin is None else origin,  # type: ignore[arg-type]  # a str by another name
            additional_headers=headers,
            open_timeout=PATIENCE_S,
            max_size=None,
            proxy=None,
        )

    def __enter__(self) -> Page:
        self._socket: ClientConnection = self._connecting.__enter__()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._connecting.__exit__(kind, error, trace)

    def send(self, message: str | bytes | dict[str, Any]) -> None:
        """Send a message."""
        self._socket.send(json.dumps(message) if isinstance(message, dict) else message)

    def next(self, *ops: str) -> dict[str, Any]:
        """The next message of one of these kinds; others are skipped."""
        while True:
            message: dict[str, Any] = json.loads(self._socket.recv(PATIENCE_S))
            if message["op"] in ops:
                return message

    def start(self, text: str, **values: str) -> None:
        """Run a program until it has begun."""
        self.send({"op": "run", "text": text, **values})
        assert (message := self.next("ready", "ended"))["op"] == "ready", message
        self.send({"op": "begin"})

    def result(self, text: str, **values: str) -> tuple[str, dict[str, Any]]:
        """Run a program to its end: its output, and how it has ended."""
        self.start(text, **values)
        return self.rest()

    def rest(self) -> tuple[str, dict[str, Any]]:
        """The output of the running program until its end, and how it has ended."""
        output = ""
        while (message := self.next("output", "ended"))["op"] == "output":
            output += message["text"]
        return output, message

    def until(self, text: str) -> str:
        """Read output until it has a text."""
        output = ""
        while text not in output:
            output += self.next("output")["text"]
        return output
