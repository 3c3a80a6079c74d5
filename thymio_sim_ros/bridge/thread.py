"""The event loop's thread: commands come in from any thread, in batches with one wake-up each."""

from __future__ import annotations

import asyncio
import socket
import threading
from collections import deque

from thymio_sim_ros.bridge.channels import Switchboard
from thymio_sim_ros.bridge.events import Command, Data
from thymio_sim_ros.bridge.messages import ServerInfo
from thymio_sim_ros.bridge.server import BridgeServer, EventSink, ServerSettings

__all__ = ["ServerThread", "listen"]

_MAX_WAITING = 10_000
"""Commands that may wait for the loop before further data is dropped."""


def listen(address: str, port: int) -> socket.socket:
    """A listening socket; port 0: any free one. Raises OSError that names address and port."""
    try:
        info = socket.getaddrinfo(address or None, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)
        family, kind, protocol, _, endpoint = info[0]
        # socket.create_server leaves the protocol at 0, and asyncio then leaves Nagle on: 40 ms per answer (measured).
        listener = socket.socket(family, kind, protocol)
    except OSError as error:
        raise _named(error, address, port) from error
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(endpoint)
        listener.listen(128)
    except OSError as error:
        listener.close()
        raise _named(error, address, port) from error
    return listener


def _named(error: OSError, address: str, port: int) -> OSError:
    return OSError(error.errno, f"cannot listen on {address}:{port}: {(error.strerror or str(error)).lower()}")


class ServerThread:
    """A running bridge. The port is bound when the constructor returns; `close` leaves nothing behind."""

    def __init__(
        self,
        info: ServerInfo,
        sink: EventSink,
        *,
        address: str = "127.0.0.1",
        port: int = 8765,
        settings: ServerSettings | None = None,
    ) -> None:
        self._listener = listen(address, port)
        self._server = BridgeServer(Switchboard(info), sink, settings)
        self._waiting: deque[Command] = deque()
        self._wake_is_due = False
        self._loop = asyncio.new_event_loop()
        self._stop = asyncio.Event()
        self._thread = threading.Thread(target=self._run, name="foxglove-server", daemon=True)
        self._is_closed = False
        self.address: str
        self.port: int
        self.address, self.port = self._listener.getsockname()[:2]
        self._thread.start()

    def post(self, command: Command) -> None:
        """Hand a command to the loop; order is kept. Any one thread at a time."""
        if isinstance(command, Data) and len(self._waiting) >= _MAX_WAITING:
            return
        self._waiting.append(command)
        if not self._wake_is_due and not self._is_closed:
            self._wake_is_due = True
            self._loop.call_soon_threadsafe(self._drain)

    def close(self) -> None:
        """End the server, its connections and the thread."""
        if self._is_closed:
            return
        self._is_closed = True
        self._loop.call_soon_threadsafe(self._stop.set)
        self._thread.join()

    def _drain(self) -> None:
        self._wake_is_due = False
        batch = []
        while self._waiting:
            batch.append(self._waiting.popleft())
        self._server.apply(batch)

    def _run(self) -> None:
        try:
            self._loop.run_until_complete(self._serve())
        finally:
            self._loop.run_until_complete(self._loop.shutdown_asyncgens())
            self._loop.close()

    async def _serve(self) -> None:
        await self._server.start(self._listener)
        await self._stop.wait()
        await self._server.close()
