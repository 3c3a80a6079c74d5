"""A client of rosbridge for tests that spin an executor: nothing in it blocks."""

from __future__ import annotations

import json
from collections.abc import Callable
from types import TracebackType
from typing import Any

import cbor2
from websockets.sync.client import ClientConnection, connect

__all__ = ["RosClient"]


class RosClient:
    """Sends operations, and keeps those that arrive; `until`, given by the test, spins the executor."""

    def __init__(self, port: int, until: Callable[..., object], path: str = "/") -> None:
        self._connecting = connect(f"ws://127.0.0.1:{port}{path}", max_size=None, max_queue=None)
        self._until = until
        self.received: list[dict[str, Any]] = []
        """What has arrived, in order; `next` takes from here."""

    def __enter__(self) -> RosClient:
        self.connection: ClientConnection = self._connecting.__enter__()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._connecting.__exit__(kind, error, trace)

    def send(self, op: str, **fields: object) -> None:
        """Send an operation as JSON."""
        self.connection.send(json.dumps({"op": op, **fields}))

    def send_cbor(self, op: str, **fields: object) -> None:
        """Send an operation as CBOR."""
        self.connection.send(cbor2.dumps({"op": op, **fields}))

    def next(self, op: str, where: Callable[[dict[str, Any]], bool] = lambda operation: True) -> dict[str, Any]:
        """The next operation of this name that satisfies the condition; earlier ones are dropped."""

        def found() -> bool:
            self.read()
            return any(each["op"] == op and where(each) for each in self.received)

        self._until(found, what=f"{op}; received {str(self.received[-5:])[:1000]}")
        while True:
            operation = self.received.pop(0)
            if operation["op"] == op and where(operation):
                return operation

    def call(self, service: str, **fields: object) -> dict[str, Any]:
        """The answer to a call."""
        self.send("call_service", service=service, **fields)
        return self.next("service_response")

    def read(self) -> None:
        """Read what has arrived."""
        while True:
            try:
                frame = self.connection.recv(timeout=0)
            except TimeoutError:
                return
            self.received.append(json.loads(frame) if isinstance(frame, str) else cbor2.loads(frame))
