"""The asyncio side: sockets around the switchboard, on the current API of `websockets`.

Everything here runs in one event loop, but for commands and messages, which any thread gives to the kernel itself.
Switchboard and outlets therefore belong to whoever has the turn, which nobody keeps while it waits for something.
Nothing waits for a client: each has its `Outlet`; reading pauses for a client while the owner of the data is behind,
which slows that client only.
"""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import logging
import ssl
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from http import HTTPStatus
from socket import socket
from typing import Any, Protocol, cast

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed, NegotiationError
from websockets.frames import CloseCode
from websockets.http11 import Request, Response
from websockets.typing import Subprotocol

from thymio_sim_ros.bridge.access import Attempts, Tokens, given_token
from thymio_sim_ros.bridge.client_send_queue import Outlet, Way
from thymio_sim_ros.bridge.constants import SUBPROTOCOLS, StatusLevel
from thymio_sim_ros.bridge.errors import FrameError
from thymio_sim_ros.bridge.events import Command, Data, Event, RemoveChannels
from thymio_sim_ros.bridge.fair_lock import Turn
from thymio_sim_ros.bridge.framing import framed
from thymio_sim_ros.bridge.messages import ServerMessage, Status, Time, Unsubscribe
from thymio_sim_ros.bridge.origin_policy import is_allowed
from thymio_sim_ros.bridge.switchboard import Letter, Routes, Switchboard
from thymio_sim_ros.bridge.transport import SLICE_S, SharedConnection
from thymio_sim_ros.bridge.wire import decode_client, encode_server

__all__ = ["WRONG_TOKEN", "BridgeServer", "EventSink", "ServerSettings"]

_FLUSH_PERIOD_S = 0.01
_FULL_PAUSE_S = 0.005
WRONG_TOKEN = 4401
"""Close code for a page without a valid token: a browser tells its pages nothing of a refused handshake."""
_NO_TOKEN_TEXT = "a token is needed: open the whole address in the simulator's terminal, or append ?token=… to this one"
_WRONG_TOKEN_TEXT = (
    "the token is wrong or of an earlier start: open the address that is in the simulator's terminal now"
)
_WARN_EVERY_S = 60.0
_CLOSE_S = 0.3
BACKLOG = 128
"""So many clients may wait to be let in."""
_ACCEPTED_AT_ONCE = 4
"""Connections that are accepted in one turn of the loop: a handshake takes it 3 ms."""
_NO_WAYS: tuple[Routes, tuple[Way, ...]] = ((), ())
_SMALL_SHARE = 0.05
"""Of the loop's time: a client that takes less is served without a pause."""
_TIME_SLOT = -1
"""Where an outlet keeps the newest time; no subscription has this id."""


class EventSink(Protocol):
    """Where events go; called in the event loop, must not block."""

    def is_full(self, client: int) -> bool:
        """Whether events of this client pile up, so that it should be read more slowly."""

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
    max_clients: int = 128
    """Clients at a time; more are refused. As many connections again may be on their way to become clients."""
    ping_interval_s: float = 10.0
    ping_timeout_s: float = 20.0
    tls: ssl.SSLContext | None = None
    tokens: Tokens = field(default_factory=Tokens)
    changes_nothing: Callable[[str], bool] = lambda service: False
    """Which services a read-only client may call, by name."""


class BridgeServer:
    """A Foxglove server on its listening sockets.

    `carry_out` and `publish` may be called by any thread, as long as the event loop has not been closed before `close`;
    the other methods belong to the event loop's.
    """

    def __init__(self, board: Switchboard, sink: EventSink, settings: ServerSettings | None = None) -> None:
        self._board = board
        self._routed, self._kept = board.routed, board.kept
        self._ways: dict[int, tuple[Routes, tuple[Way, ...]]] = {}
        """How the data of channels get to those who are routed, as long as these are the same."""
        self._sink = sink
        self._settings = settings or ServerSettings()
        self._log = logging.getLogger(__name__)
        self._outlets: dict[int, Outlet] = {}
        self._client_ids = itertools.count(1)
        self._attempts = Attempts(time.monotonic)
        self._warned_s: dict[str, float] = {}
        self._flush_is_due = False
        self._loop: asyncio.AbstractEventLoop
        self._servers: list[Server] = []
        self._turn = Turn()
        """Of the thread that works on board and outlets."""
        self._frames: dict[type, tuple[ServerMessage, bytes]] = {}
        """The frames of what every newcomer is told, as long as that is the same."""
        self._rest_lock: asyncio.Lock
        """Clients rest one after the other: see `_rest`."""
        self._is_crowded = False
        self._is_closing = False
        self._connections: set[SharedConnection] = set()
        """Those that are no clients yet, too."""

    async def start(self, listeners: Iterable[socket]) -> None:
        """Serve on bound sockets, which become the server's own."""
        self._loop = asyncio.get_running_loop()
        self._rest_lock = asyncio.Lock()
        settings = self._settings
        # Refused handshakes are answered with their reason; websockets would log each with a traceback.
        log = logging.getLogger(f"{__name__}.websockets")
        log.setLevel(logging.CRITICAL)
        for listener in listeners:
            server = await serve(
                self._serve_client,
                sock=listener,
                ssl=settings.tls,
                create_connection=cast("type[ServerConnection]", self._make_connection),
                select_subprotocol=_select_subprotocol,
                process_request=self._check_access,
                compression=None,
                server_header=None,
                max_size=settings.max_message_size,
                ping_interval=settings.ping_interval_s,
                ping_timeout=settings.ping_timeout_s,
                close_timeout=_CLOSE_S,
                backlog=_ACCEPTED_AT_ONCE,
                logger=log,
            )
            listener.listen(BACKLOG)  # more may wait than are accepted at once
            self._servers.append(server)

    async def close(self) -> None:
        """Say goodbye to all clients; those that do not listen are cut off after `_CLOSE_S`."""
        self._is_closing = True
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

    def carry_out(self, command: Command) -> None:
        """Do what the owner of the data wants; in any thread."""
        with self._turn:
            try:
                self._deliver(self._board.apply(command))
            except Exception:
                # Our own mistake must not end the owner's thread: what clients have not been told of it is lost.
                self._log.exception("%s failed", type(command).__name__)
            if isinstance(command, RemoveChannels):
                self._ways.clear()

    def publish(self, channel_id: int, time_ns: int, payload: bytes) -> None:
        """Send a message to everybody who gets the channel; in any thread. Hot path."""
        self._turn.take()
        try:
            routes = self._routed.get(channel_id)
            if routes is None:
                return  # nothing is kept either: it would be old when somebody comes
            if channel_id in self._kept:
                self._board.keep(Data(channel_id, time_ns, payload))
            known, ways = self._ways.get(channel_id, _NO_WAYS)
            if known is not routes:
                ways = tuple(self._outlets[client].way(subscription_id) for client, subscription_id in routes)
                self._ways[channel_id] = (routes, ways)
            for send in ways:
                if not send(time_ns, payload):
                    self._see_to_flushing()
        except Exception:
            self._log.exception("a message of channel %d failed", channel_id)
        finally:
            self._turn.give_back()

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
                elif not self._outlets[client].data(_TIME_SLOT, frame):
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

    def _make_connection(self, *arguments: Any, **options: Any) -> SharedConnection:
        connection = SharedConnection(*arguments, **options)
        if len(self._connections) < 2 * self._settings.max_clients:
            self._connections.add(connection)
            connection.on_lost = lambda: self._connections.discard(connection)
        else:
            connection.is_refused = True
            self._refuse_crowd()
        return connection

    async def _serve_client(self, connection: ServerConnection) -> None:
        assert isinstance(connection, SharedConnection)
        if len(self._outlets) >= self._settings.max_clients:
            self._refuse_crowd()
            await connection.close(CloseCode.TRY_AGAIN_LATER, "too many clients")
            return
        if connection.role is None:
            await self._turn_away(connection)
            return
        client = next(self._client_ids)
        outlet = Outlet(connection, self._settings.buffer_limit)
        began_s = time.thread_time()
        with self._turn:
            self._outlets[client] = outlet
            for message in self._board.join(client, connection.role):
                outlet.control(self._greeting_frame(message))
        self._is_crowded = self._is_crowded and len(self._outlets) >= self._settings.max_clients
        try:
            await self._rest(time.thread_time() - began_s)
            await self._read(client, connection)
        except ConnectionClosed:
            pass  # a lost connection ends like a closed one
        finally:
            with self._turn:
                del self._outlets[client]
                self._ways.clear()  # they would keep what is gone
                events = self._board.leave(client)
            self._tell(events)

    async def _read(self, client: int, connection: SharedConnection) -> None:
        """Receive a client's messages until it leaves."""
        spent_s, since_s = 0.0, time.monotonic()
        async for frame in connection:
            if self._is_closing:
                return
            began_s = time.thread_time()
            self._receive(client, frame)
            spent_s += time.thread_time() - began_s
            while self._sink.is_full(client) and not self._is_closing:
                await asyncio.sleep(_FULL_PAUSE_S)
            if spent_s >= SLICE_S:
                # A client that takes little of the loop's time does not queue behind those that rest.
                if spent_s > _SMALL_SHARE * (time.monotonic() - since_s):
                    await self._rest(spent_s)
                spent_s, since_s = 0.0, time.monotonic()

    async def _rest(self, spent_s: float) -> None:
        """Pause a client that took so much of the loop's time for as long, while no other client rests.

        So all busy clients together take half of the loop's time, and between two of their turns others are served,
        however many are busy.
        """
        async with self._rest_lock:
            if not self._is_closing:
                await asyncio.sleep(spent_s)

    def _greeting_frame(self, message: ServerMessage) -> bytes:
        """The frame of a message of the greeting; those of 1500 topics are 2 MB and the same for every newcomer."""
        known = self._frames.get(type(message))
        if known is None or known[0] is not message:
            known = self._frames[type(message)] = message, framed(encode_server(message))
        return known[1]

    def _refuse_crowd(self) -> None:
        """Log that there are too many clients, once until there are fewer."""
        if not self._is_crowded:
            self._is_crowded = True
            self._log.warning("%d clients are connected: more are refused", self._settings.max_clients)

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

    def _check_access(self, connection: ServerConnection, request: Request) -> Response | None:
        """Refuse a handshake without a valid token or from a foreign page; a valid token vouches for its page."""
        assert isinstance(connection, SharedConnection)
        tokens, address = self._settings.tokens, _address(connection)
        token = given_token(request.path, request.headers.get_all("Authorization"))
        if tokens.is_required and not self._attempts.may_try(address):
            self._warn("attempts", f"too many connections from {address} with a wrong token; its others have to wait")
            return connection.respond(HTTPStatus.TOO_MANY_REQUESTS, "Too many wrong tokens; wait some seconds.\n")
        connection.role = tokens.role(token)
        origin, host = _header(request.headers, "Origin"), _header(request.headers, "Host")
        if connection.role is None:
            self._attempts.failed(address)
            self._warn("token", f"refused a connection from {address}: its token is wrong or missing")
            if origin is not None:
                return None  # it is told once it is connected
            response = connection.respond(HTTPStatus.UNAUTHORIZED, f"{_token_text(request)}\n")
            response.headers["WWW-Authenticate"] = "Bearer"
            return response
        if tokens.is_required or is_allowed(origin, host, self._settings.allowed_origins):
            return None
        self._warn("origin", f"refused a web page from {origin:.100}: add it to allowed_origins if it is yours")
        return connection.respond(HTTPStatus.FORBIDDEN, f"Pages from {origin} may not connect; see allowed_origins.\n")

    async def _turn_away(self, connection: SharedConnection) -> None:
        """Say why in the words of the protocol, and close."""
        assert connection.request is not None
        text = _token_text(connection.request)
        with contextlib.suppress(ConnectionClosed):
            await connection.send(encode_server(Status(StatusLevel.ERROR, text, "access")))
            await connection.close(WRONG_TOKEN, "wrong or missing token")

    def _warn(self, about: str, text: str) -> None:
        """Log a warning, about each thing at most once in `_WARN_EVERY_S`: strangers can cause it at will."""
        now_s = time.monotonic()
        if now_s - self._warned_s.get(about, -_WARN_EVERY_S) >= _WARN_EVERY_S:
            self._warned_s[about] = now_s
            self._log.warning("%s", text)


def _address(connection: ServerConnection) -> str:
    peer = connection.remote_address
    return str(peer[0]) if peer else ""


def _token_text(request: Request) -> str:
    given = given_token(request.path, request.headers.get_all("Authorization"))
    return _NO_TOKEN_TEXT if given is None else _WRONG_TOKEN_TEXT


def _header(headers: Headers, name: str) -> str | None:
    """The header's value, the last one if it is repeated."""
    values = headers.get_all(name)
    return values[-1] if values else None


def _select_subprotocol(_connection: ServerConnection, offered: Sequence[Subprotocol]) -> Subprotocol:
    for name in SUBPROTOCOLS:
        if name in offered:
            return name
    raise NegotiationError(f"offer one of the sub-protocols {', '.join(SUBPROTOCOLS)}")
