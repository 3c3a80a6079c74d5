"""The asyncio side: sockets around the switchboard, on the current API of `websockets`.

Everything here runs in one event loop, but for commands, which another thread may carry out itself (`apply_now`).
Switchboard and outlets therefore belong to whoever has the turn: the loop while it handles something, else the thread
that has a command. Nothing waits for a client: each has its `Outlet`; reading pauses for a client while the owner of
the data is behind, which slows that client only.
"""

from __future__ import annotations

import asyncio
import itertools
import logging
import ssl
import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from http import HTTPStatus
from socket import socket
from typing import Protocol

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed, NegotiationError
from websockets.http11 import Request, Response
from websockets.typing import Subprotocol

from thymio_sim_ros.bridge.channels import Letter, Switchboard
from thymio_sim_ros.bridge.errors import FrameError
from thymio_sim_ros.bridge.events import Command, Data, Event
from thymio_sim_ros.bridge.framing import binary_head, framed
from thymio_sim_ros.bridge.messages import Status, Time, Unsubscribe
from thymio_sim_ros.bridge.origins import is_allowed
from thymio_sim_ros.bridge.outlet import Outlet
from thymio_sim_ros.bridge.transport import SharedConnection
from thymio_sim_ros.bridge.turn import Turn
from thymio_sim_ros.bridge.vocabulary import SUBPROTOCOLS, StatusLevel
from thymio_sim_ros.bridge.wire import DATA_HEAD_SIZE, data_head, decode_client, encode_server

__all__ = ["BridgeServer", "EventSink", "ServerSettings"]

_FLUSH_PERIOD_S = 0.01
_FULL_PAUSE_S = 0.005
_CLOSE_S = 0.3
_TIME_SLOT = -1
"""Where an outlet keeps the newest time; no subscription has this id."""


class EventSink(Protocol):
    """Where events go; called in the event loop, must not block."""

    @property
    def is_full(self) -> bool:
        """Whether events pile up, so that clients should be read more slowly."""

    def post(self, event: Event) -> None:
        """Take an event."""


@dataclass(frozen=True, slots=True)
class ServerSettings:
    """Limits and manners of a server."""

    allowed_origins: tuple[str, ...] = ()
    """Origins of web pages beside those of `origins`; `*`: all."""
    buffer_limit: int = 1 << 20
    """Bytes that may wait for a client before data is thinned out."""
    max_message_size: int = 4 << 20
    """Longest frame accepted from a client, bytes."""
    ping_interval_s: float = 10.0
    ping_timeout_s: float = 20.0
    tls: ssl.SSLContext | None = None


class BridgeServer:
    """A Foxglove server on its listening sockets. Methods belong to the event loop's thread, but for `apply_now`."""

    def __init__(self, board: Switchboard, sink: EventSink, settings: ServerSettings | None = None) -> None:
        self._board = board
        self._sink = sink
        self._settings = settings or ServerSettings()
        self._log = logging.getLogger(__name__)
        self._outlets: dict[int, Outlet] = {}
        self._client_ids = itertools.count(1)
        self._flush_is_due = False
        self._loop: asyncio.AbstractEventLoop
        self._servers: list[Server] = []
        self._turn = Turn()
        """Of the thread that works on board and outlets."""

    async def start(self, listeners: Iterable[socket]) -> None:
        """Serve on bound sockets, which become the server's own."""
        self._loop = asyncio.get_running_loop()
        settings = self._settings
        # Refused handshakes are answered with their reason; websockets would log each with a traceback.
        log = logging.getLogger(f"{__name__}.websockets")
        log.setLevel(logging.CRITICAL)
        for listener in listeners:
            server = await serve(
                self._serve_client,
                sock=listener,
                ssl=settings.tls,
                create_connection=SharedConnection,
                select_subprotocol=_select_subprotocol,
                process_request=self._check_origin,
                compression=None,
                server_header=None,
                max_size=settings.max_message_size,
                ping_interval=settings.ping_interval_s,
                ping_timeout=settings.ping_timeout_s,
                close_timeout=_CLOSE_S,
                logger=log,
            )
            self._servers.append(server)

    async def close(self) -> None:
        """Say goodbye to all clients; those that do not listen are cut off after `_CLOSE_S`."""
        for server in self._servers:
            server.close()
        closed = asyncio.gather(*(server.wait_closed() for server in self._servers))
        await asyncio.wait([closed], timeout=_CLOSE_S)
        for outlet in self._outlets.values():
            outlet.abort()
        await closed

    @property
    def client_count(self) -> int:
        """Connected clients."""
        return len(self._outlets)

    def apply(self, commands: Iterable[Command]) -> None:
        """Carry out commands in order; they are taken while it is the loop's turn."""
        with self._turn:
            for command in commands:
                self._apply(command)

    def apply_now(self, command: Command) -> bool:
        """Carry out a command in the calling thread, unless the loop is at work; returns whether it was done."""
        if not self._turn.take():
            return False
        try:
            self._apply(command)
        finally:
            self._turn.give_back()
        return True

    def _apply(self, command: Command) -> None:
        try:
            if isinstance(command, Data):
                self._publish(command)
            else:
                self._deliver(self._board.apply(command))
        except Exception:
            # Our own mistake must not end the owner's thread: what clients have not been told of it is lost.
            self._log.exception("%s failed", type(command).__name__)

    def _publish(self, data: Data) -> None:
        """Hot path: one frame per distinct subscription id."""
        self._board.keep(data)
        routes = self._board.routes(data.channel_id)
        if not routes:
            return
        now_s = time.monotonic()
        head = binary_head(DATA_HEAD_SIZE + len(data.payload))
        frames: dict[int, bytes] = {}
        for client, subscription_id in routes:
            frame = frames.get(subscription_id)
            if frame is None:
                frame = frames[subscription_id] = head + data_head(subscription_id, data.time_ns) + data.payload
            if not self._outlets[client].data(subscription_id, frame, now_s):
                self._see_to_flushing()

    def _see_to_flushing(self) -> None:
        if not self._flush_is_due:
            self._flush_is_due = True
            self._loop.call_soon_threadsafe(self._flush_soon)

    def _deliver(self, letters: Sequence[Letter]) -> None:
        for letter in letters:
            frame = framed(encode_server(letter.message))
            for client in letter.clients:
                if not isinstance(letter.message, Time):
                    self._outlets[client].control(frame)
                elif not self._outlets[client].data(_TIME_SLOT, frame, time.monotonic()):
                    self._see_to_flushing()

    def _flush_soon(self) -> None:
        self._loop.call_later(_FLUSH_PERIOD_S, self._flush)

    def _flush(self) -> None:
        with self._turn:
            for outlet in self._outlets.values():
                outlet.flush()
            self._flush_is_due = any(outlet.is_behind for outlet in self._outlets.values())
        if self._flush_is_due:
            self._flush_soon()

    async def _serve_client(self, connection: ServerConnection) -> None:
        assert isinstance(connection, SharedConnection)
        client = next(self._client_ids)
        outlet = Outlet(connection, self._settings.buffer_limit)
        with self._turn:
            self._outlets[client] = outlet
            for message in self._board.join(client):
                outlet.control(framed(encode_server(message)))
        try:
            async for frame in connection:
                self._receive(client, frame)
                while self._sink.is_full:
                    await asyncio.sleep(_FULL_PAUSE_S)
        except ConnectionClosed:
            pass  # a lost connection ends like a closed one
        finally:
            with self._turn:
                del self._outlets[client]
                events = self._board.leave(client)
            self._tell(events)

    def _receive(self, client: int, frame: str | bytes) -> None:
        try:
            message = decode_client(frame)
        except FrameError as error:
            with self._turn:
                self._outlets[client].control(framed(encode_server(Status(StatusLevel.ERROR, str(error)))))
            return
        with self._turn:
            outcome = self._board.receive(client, message)
            if isinstance(message, Unsubscribe):
                for subscription_id in message.subscription_ids:
                    self._outlets[client].forget(subscription_id)
            self._deliver(outcome.letters)
        self._tell(outcome.events)

    def _tell(self, events: Iterable[Event]) -> None:
        for event in events:
            self._sink.post(event)

    def _check_origin(self, connection: ServerConnection, request: Request) -> Response | None:
        origin, host = _header(request.headers, "Origin"), _header(request.headers, "Host")
        if is_allowed(origin, host, self._settings.allowed_origins):
            return None
        self._log.warning("refused a web page from %s: add it to allowed_origins if it is yours", origin)
        return connection.respond(HTTPStatus.FORBIDDEN, f"Pages from {origin} may not connect; see allowed_origins.\n")


def _header(headers: Headers, name: str) -> str | None:
    """The header's value, the last one if it is repeated."""
    values = headers.get_all(name)
    return values[-1] if values else None


def _select_subprotocol(_connection: ServerConnection, offered: Sequence[Subprotocol]) -> Subprotocol:
    for name in SUBPROTOCOLS:
        if name in offered:
            return name
    raise NegotiationError(f"offer one of the sub-protocols {', '.join(SUBPROTOCOLS)}")
