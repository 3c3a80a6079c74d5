"""HTTP and WebSocket connections with limits, on aiohttp: the part that all HTTP servers of this project share.

aiohttp itself has no limits for clients that connect and send nothing, send slowly, or do not read. Each connection
has a slot (`connections`), whose phase follows the traffic; `HttpConnections` closes those that are overdue. A server
is a function from a request to a response; it calls `start_answer` once the request is complete, and `start_stream` if
the answer has no end. A connection that becomes a WebSocket is a stream: its server limits what it sends and receives.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import selectors
import ssl
from collections.abc import Awaitable, Callable, Iterable, Mapping
from functools import partial
from socket import SHUT_RDWR, SO_SNDBUF, SOL_SOCKET, socket
from types import MappingProxyType
from typing import Any, cast

from aiohttp import StreamReader, web

from thymio_sim_ros.bridge.connections import Connections, ConnectionSlot, Phase

__all__ = [
    "COMMON_HEADERS",
    "Handler",
    "HttpConnections",
    "Report",
    "serve_connections",
    "start_answer",
    "start_stream",
    "text_response",
]

Handler = Callable[[web.BaseRequest], Awaitable[web.StreamResponse]]

Report = Callable[[str, str], None]
"""Called with a kind of problem and its description."""

BACKLOG = 1024
"""Connections that the kernel queues until they are accepted."""
SEND_BUFFER = 131_072
"""Bytes that the kernel buffers for a client that does not read; by default these are megabytes."""
MAX_AHEAD = 65_536
"""Bytes that a client may send while its request is answered: further requests, or an unread body."""
COMMON_HEADERS = {
    "Server": "thymio-sim",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
}
"""Headers of every response."""
_CLOSE_S = 0.3
_LINGER_S = 5.0
"""Longest time in which the rest of a body that is refused is received and dropped. A connection that is closed before
it has been read is reset by the kernel, and many clients then show that instead of the answer. The time limits of
`connections` apply as well."""
_SWEEP_S = 0.5
_RETRY_S = 0.02
_ITERATIONS = 6
"""Iterations of the event loop from the arrival of a request to the beginning of its answer, and some more."""
_NEVER_S = 1e6
_TEXT = "text/plain; charset=utf-8"


class _Connection(web.RequestHandler):
    """A connection with a slot."""

    def __init__(
        self, server: web.Server, connections: Connections, slot: ConnectionSlot, report: Report, **options: Any
    ) -> None:
        super().__init__(server, **options)
        self._connections = connections
        self._slot = slot
        self._report = report
        self._ahead = 0
        self._busy = Phase.ANSWERING
        self._is_websocket = False
        self._stream: asyncio.Task[Any] | None = None
        self._body: StreamReader | None = None
        """The body of the request that is answered; its unread part is dropped after the answer."""

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Connect the slot with the transport."""
        plain = cast(asyncio.Transport, transport)
        descriptor = plain.get_extra_info("socket").fileno()
        self._slot.close = partial(_abort, plain)
        self._slot.has_pending_io = lambda: _is_ready(
            descriptor, selectors.EVENT_WRITE if self._slot.phase is Phase.STALLED else selectors.EVENT_READ
        )
        super().connection_made(transport)

    def connection_lost(self, exc: BaseException | None) -> None:
        """Free the slot and end the stream."""
        self._connections.remove(self._slot)
        if self._stream is not None:
            self._stream.cancel()
        if self._body is not None and not self._body.is_eof():
            self._body.feed_eof()  # aiohttp would wait for the rest until the end of `_LINGER_S`
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Pass bytes on; close the connection if the client sends too many before its answer is complete."""
        slot = self._slot
        if slot.phase in (Phase.SILENT, Phase.IDLE):
            self._connections.set_phase(slot, Phase.READING)
        elif slot.phase is not Phase.READING and not self._is_websocket:
            self._ahead += len(data)
            if self._ahead > MAX_AHEAD:
                slot.close()
                return
        super().data_received(data)

    def eof_received(self) -> None:
        """Close the connection if no answer is being created: the client sends no more bytes."""
        if self._slot.phase < Phase.STALLED or self._slot.phase is Phase.STREAMING:
            self.force_close()

    def pause_writing(self) -> None:
        """Note that the client reads more slowly than the answer is sent; WebSockets have limits and pings for that."""
        super().pause_writing()
        if not self._is_websocket:
            self._connections.set_phase(self._slot, Phase.STALLED)

    def resume_writing(self) -> None:
        """Note that the client reads again."""
        super().resume_writing()
        self._connections.set_phase(self._slot, self._busy)

    def start_answer(self) -> None:
        """Note that a request is complete."""
        self._connections.set_phase(self._slot, Phase.ANSWERING)

    def start_stream(self) -> None:
        """Note that the answer has no end; the current task, which writes it, is canceled when the client leaves."""
        self._busy, self._stream = Phase.STREAMING, asyncio.current_task()
        self._connections.set_phase(self._slot, Phase.STREAMING)

    def set_parser(self, *arguments: Any, **options: Any) -> None:
        """Note that the connection has become a WebSocket, as aiohttp does at the end of the handshake."""
        self._is_websocket = True
        self._connections.set_phase(self._slot, Phase.STREAMING)
        super().set_parser(*arguments, **options)

    async def finish_response(self, request: web.BaseRequest, *arguments: Any, **options: Any) -> Any:
        """Send an answer; afterwards the client may send another request."""
        self._body = request.content
        try:
            return await super().finish_response(request, *arguments, **options)
        finally:
            self._ahead = 0
            self._busy, self._stream = Phase.ANSWERING, None
            self._connections.set_phase(self._slot, Phase.IDLE)

    def handle_error(
        self,
        request: web.BaseRequest,
        status: int = 500,
        exc: BaseException | None = None,
        message: str | None = None,
    ) -> web.StreamResponse:
        """The response to an invalid request or an internal error; it quotes nothing of the request."""
        has_left = self.transport is None or self.transport.is_closing()
        if status >= 500 and not has_left:  # aiohttp raises several kinds of errors for clients that have left
            self._report("fault", f"internal error (please report): {exc!r}")
        response = text_response(status, "This is not a request that can be answered.")
        response.force_close()
        return response


class _Acceptor:
    """Accepts connections while there are slots."""

    def __init__(self, server: web.Server, connections: Connections, report: Report, log: logging.Logger) -> None:
        self._server = server
        self._connections = connections
        self._report = report
        self._log = log
        self._connecting: set[asyncio.Task[None]] = set()

    async def accept_forever(self, listener: socket, tls: ssl.SSLContext | None) -> None:
        """Accept the connections of a listening socket, until it is canceled."""
        listener.setblocking(False)
        listener.setsockopt(SOL_SOCKET, SO_SNDBUF, SEND_BUFFER)  # accepted sockets inherit it
        listener.listen(BACKLOG)
        while True:
            try:
                accepted, peer = listener.accept()
            except BlockingIOError:
                await _readable(listener)
                continue
            except (InterruptedError, ConnectionAbortedError):  # the client has disconnected
                continue
            except OSError as error:  # out of file descriptors
                self._report("accept", f"connections cannot be accepted: {error.strerror}")
                await asyncio.sleep(_SWEEP_S)
                continue
            accepted.setblocking(False)
            try:
                while self._connections.is_full:
                    self._report("full", "the maximum number of connections is reached; more have to wait")
                    await self._make_room()
            except asyncio.CancelledError:
                accepted.close()
                raise
            self.add(accepted, str(peer[0]), tls)
            await asyncio.sleep(0)

    def add(self, accepted: socket, address: str, tls: ssl.SSLContext | None) -> None:
        """Serve a connected socket that does not block; only allowed while there are slots."""
        slot = self._connections.add(address)
        # In a task of its own: a handshake of TLS takes as long as the client wants.
        task = asyncio.get_running_loop().create_task(self._connect(slot, accepted, tls))
        slot.close = task.cancel
        self._connecting.add(task)
        task.add_done_callback(self._connecting.discard)

    async def _connect(self, slot: ConnectionSlot, accepted: socket, tls: ssl.SSLContext | None) -> None:
        loop = asyncio.get_running_loop()
        is_connected = False
        try:
            await loop.connect_accepted_socket(partial(self._connection, slot), accepted, ssl=tls)
            is_connected = True
        except OSError:  # the client has disconnected, or makes no handshake
            pass
        finally:
            if not is_connected:
                self._connections.remove(slot)
                accepted.close()

    async def _make_room(self) -> None:
        """Close the best candidate for eviction, unless it becomes active in the next iterations of the event loop."""
        slot = self._connections.eviction_candidate()
        if slot is None:
            await asyncio.sleep(_RETRY_S)
            return
        since_s = slot.since_s
        for _ in range(_ITERATIONS):
            await asyncio.sleep(0)
        self._connections.evict(slot, since_s)

    def _connection(self, slot: ConnectionSlot) -> _Connection:
        return _Connection(
            self._server,
            self._connections,
            slot,
            self._report,
            loop=asyncio.get_running_loop(),
            keepalive_timeout=_NEVER_S,  # `connections` closes idle connections
            access_log=None,
            logger=self._log,
            lingering_time=_LINGER_S,
        )


def start_answer(request: web.BaseRequest) -> None:
    """Note that a request is complete: from now on, the client waits for the server."""
    cast(_Connection, request.protocol).start_answer()


def start_stream(request: web.BaseRequest) -> None:
    """Note that the answer has no end. The current task is canceled when the client closes the connection."""
    cast(_Connection, request.protocol).start_stream()


def text_response(status: int, text: str, headers: Mapping[str, str] = MappingProxyType({})) -> web.Response:
    """A line of plain text that is not stored."""
    given = {**COMMON_HEADERS, "Content-Type": _TEXT, "Cache-Control": "no-store", **headers}
    return web.Response(status=status, body=f"{text}\n".encode(), headers=given)


class HttpConnections:
    """The connections of all listening sockets of a server. Only for the thread of the event loop."""

    def __init__(
        self,
        answer: Handler,
        max_connections: int,
        report: Report,
        loop: asyncio.AbstractEventLoop,
        *,
        is_patient: bool = False,
    ) -> None:
        """`is_patient`: for processes of this program, whose requests may take long on a busy machine."""
        self._log = logging.getLogger(__name__)
        self._log.setLevel(logging.CRITICAL)  # invalid requests are not logged; internal errors go to `report`
        self._loop = loop
        self.slots = Connections(max_connections, loop.time)
        """The open connections."""
        self._server = web.Server(answer, loop=loop)
        self._acceptor = _Acceptor(self._server, self.slots, report, self._log)
        self._tasks = [] if is_patient else [self._loop.create_task(self._close_overdue())]

    def accept(self, listeners: Iterable[socket], tls: ssl.SSLContext | None = None) -> None:
        """Accept the connections of further sockets."""
        self._tasks += [self._loop.create_task(self._acceptor.accept_forever(listener, tls)) for listener in listeners]

    def add(self, connected: socket) -> None:
        """Serve a connected socket, such as an end of a pair; it is closed if there is no slot."""
        if self.slots.is_full:
            connected.close()
            return
        connected.setblocking(False)
        connected.setsockopt(SOL_SOCKET, SO_SNDBUF, SEND_BUFFER)
        self._acceptor.add(connected, "", None)

    async def close(self) -> None:
        """Accept no more connections, and close those that are open; the listening sockets stay as they are."""
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        await self._server.shutdown(_CLOSE_S)
        self.slots.close_all()  # with TLS, connections would wait for their clients beyond the end of the loop
        for _ in range(_ITERATIONS):
            await asyncio.sleep(0)

    async def _close_overdue(self) -> None:
        while True:
            await asyncio.sleep(_SWEEP_S)
            self.slots.close_overdue()


async def serve_connections(
    listeners: Iterable[socket],
    answer: Handler,
    max_connections: int,
    report: Report,
    stop: asyncio.Event,
    tls: ssl.SSLContext | None = None,
) -> None:
    """Serve on listening sockets, with TLS if there is a context, until `stop` is set; connections are closed then."""
    connections = HttpConnections(answer, max_connections, report, asyncio.get_running_loop())
    connections.accept(listeners, tls)
    try:
        await stop.wait()
    finally:
        await connections.close()


async def _readable(listener: socket) -> None:
    """Wait for a connection. `loop.sock_accept` would lose one that it accepts while it is canceled."""
    loop = asyncio.get_running_loop()
    ready = asyncio.Event()
    loop.add_reader(listener, ready.set)
    try:
        await ready.wait()
    finally:
        loop.remove_reader(listener)


def _abort(transport: asyncio.Transport) -> None:
    """Close a connection at once. `abort` alone has no effect on one with TLS that was closed twice (Python 3.11)."""
    transport.abort()
    with contextlib.suppress(OSError):  # it is closed
        transport.get_extra_info("socket").shutdown(SHUT_RDWR)


def _is_ready(descriptor: int, events: int) -> bool:
    """Whether one of these events of `selectors` is pending for an open socket."""
    with selectors.DefaultSelector() as selector:
        selector.register(descriptor, events)
        return bool(selector.select(0))
