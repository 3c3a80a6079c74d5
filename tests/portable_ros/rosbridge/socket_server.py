"""A rosbridge server on a socket that has an empty graph, and keeps what it receives."""

from __future__ import annotations

import json
import threading
from http import HTTPStatus

from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response
from websockets.sync.server import ServerConnection, serve

from thymio_sim_ros.portable_ros.rosbridge.operations import Operation, decode

__all__ = ["SocketServer"]


class SocketServer:
    """Runs within a `with` block; `rejection` is the text with which it refuses connections, empty for none."""

    def __init__(self, port: int, rejection: str = "") -> None:
        self.received: list[Operation] = []
        self.connections: list[ServerConnection] = []
        self.rejected = 0
        self._rejection = rejection
        self._server = serve(self._serve, "127.0.0.1", port, process_request=self._check)
        self._thread = threading.Thread(target=self._server.serve_forever)

    def __enter__(self) -> SocketServer:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._server.shutdown()
        for connection in self.connections:
            connection.close()
        self._thread.join()

    def topics(self, op: str = "publish") -> list[str]:
        """The topics of the operations of a kind that were received."""
        return [one["topic"] for one in self.received if one["op"] == op]

    def _check(self, connection: ServerConnection, request: Request) -> Response | None:
        if not self._rejection:
            return None
        self.rejected += 1
        return connection.respond(HTTPStatus.UNAUTHORIZED, f"{self._rejection}\nmore\n")

    def _serve(self, connection: ServerConnection) -> None:
        self.connections.append(connection)
        try:
            for frame in connection:
                operation = decode(frame)
                self.received.append(operation)
                if operation["op"] == "graph":
                    connection.send(json.dumps({"op": "graph", "nodes": []}))
        except ConnectionClosed:
            pass
