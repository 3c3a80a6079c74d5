"""HTTP for the page, on aiohttp: GET and HEAD of documents, with limits, time-outs and headers that protect the page.

Everything runs in one event loop, except that two helper threads read documents: a playground may take some time.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import re
import select
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from socket import SO_SNDBUF, SOL_SOCKET, socket
from typing import Any, cast

from aiohttp import web

from thymio_sim_ros.resources import PAGE_BUILD_HINT
from thymio_sim_ros.sim.playground.reader import PlaygroundError
from thymio_sim_ros.web.connections import Connections, ConnectionSlot, Phase
from thymio_sim_ros.web.content import TYPES, Content, Document
from thymio_sim_ros.web.settings import Settings

__all__ = ["Report", "serve"]

Report = Callable[[str, str], None]
"""Called with a kind of problem and its description."""

BACKLOG = 1024
"""Connections that the kernel queues until they are accepted."""
SEND_BUFFER = 131_072
"""Bytes that the kernel buffers for a client that does not read; by default these are megabytes."""
MAX_AHEAD = 65_536
"""Bytes that a client may send while its request is answered: further requests, or an unread body."""
_CLOSE_S = 0.3
_SWEEP_S = 0.5
_RETRY_S = 0.02
_ITERATIONS = 6
"""Iterations of the event loop from the arrival of a request to the beginning of its answer, and some more."""
_CHUNK = 32_768
"""Bytes that are written in one iteration of the event loop: data that a client does not read is not copied as a whole,
and large answers do not delay small ones."""
_NEVER_S = 1e6
_TEXT = "text/plain; charset=utf-8"
_HASH_LIFETIME_S = 365 * 24 * 3600
_METHODS = "GET, HEAD"
_GZIP = re.compile(r"(?:^|,)\s*gzip\s*(?:;\s*q=(?!0(?:\.0*)?\s*(?:,|$))[\d.]+\s*)?(?:,|$)")
"""Matches gzip in `Accept-Encoding`, unless its quality is 0."""
_HOST = re.compile(r"(?P<name>[a-z0-9_.-]+|\[[0-9a-f:.]+\])(?::\d{1,5})?", re.IGNORECASE)
_COMMON = {
    "Server": "thymio-sim",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
}


class _Connection(web.RequestHandler):
    """A connection with a slot; aiohttp itself has no limits for missing or slow requests."""

    def __init__(
        self, server: web.Server, connections: Connections, slot: ConnectionSlot, report: Report, **options: Any
    ) -> None:
        super().__init__(server, **options)
        self._connections = connections
        self._slot = slot
        self._report = report
        self._ahead = 0

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Connect the slot with the transport."""
        plain = cast(asyncio.Transport, transport)
        descriptor = plain.get_extra_info("socket").fileno()
        self._slot.close = plain.abort
        self._slot.has_pending_io = lambda: _is_ready(
            descriptor, select.POLLOUT if self._slot.phase is Phase.STALLED else select.POLLIN
        )
        super().connection_made(transport)

    def connection_lost(self, exc: BaseException | None) -> None:
        """Free the slot."""
        self._connections.remove(self._slot)
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Pass bytes on; close the connection if the client sends too many before its answer is complete."""
        slot = self._slot
        if slot.phase in (Phase.SILENT, Phase.IDLE):
            self._connections.set_phase(slot, Phase.READING)
        elif slot.phase is not Phase.READING:
            self._ahead += len(data)
            if self._ahead > MAX_AHEAD:
                slot.close()
                return
        super().data_received(data)

    def eof_received(self) -> None:
        """Close the connection if no answer is being created: the client sends no more bytes."""
        if self._slot.phase < Phase.STALLED:
            self.force_close()

    def pause_writing(self) -> None:
        """Note that the client reads more slowly than the answer is sent."""
        super().pause_writing()
        self._connections.set_phase(self._slot, Phase.STALLED)

    def resume_writing(self) -> None:
        """Note that the client reads again."""
        super().resume_writing()
        self._connections.set_phase(self._slot, Phase.ANSWERING)

    def start_answer(self) -> None:
        """Note that a request is complete."""
        self._connections.set_phase(self._slot, Phase.ANSWERING)

    async def finish_response(self, *arguments: Any, **options: Any) -> Any:
        """Send an answer; afterwards the client may send another request."""
        try:
            return await super().finish_response(*arguments, **options)
        finally:
            self._ahead = 0
            self._connections.set_phase(self._slot, Phase.IDLE)

    def handle_error(
        self,
        request: web.BaseRequest,
        status: int = 500,
        exc: BaseException | None = None,
        message: str | None = None,
    ) -> web.StreamResponse:
        """The response to an invalid request or an internal error; it quotes nothing of the request."""
        if status >= 500:
            self._report("fault", f"internal error (please report): {exc!r}")
        response = _text(status, "This is not a request that can be answered.")
        response.force_close()
        return response


class _Page:
    """Creates the responses to requests."""

    def __init__(self, content: Content, settings: Settings, report: Report, pool: ThreadPoolExecutor) -> None:
        self._content = content
        self._settings = settings
        self._report = report
        self._pool = pool

    async def answer(self, request: web.BaseRequest) -> web.StreamResponse:
        """The response to a request."""
        cast(_Connection, request.protocol).start_answer()
        host = request.headers.get("Host")
        if host is not None and not self._settings.is_allowed_host(_host_name(host)):
            self._report(
                "host", "request with another name of this computer rejected; see parameter allowed_hosts of web_ui"
            )
            return _text(403, "This address is not one of this server's. Open it by localhost.")
        if request.method not in ("GET", "HEAD"):
            response = _text(405, "Only GET and HEAD are answered.", {"Allow": _METHODS})
            response.force_close()
            return response
        path = request.raw_path.partition("?")[0]
        try:
            found = await asyncio.get_running_loop().run_in_executor(self._pool, self._content.find, path)
        except PlaygroundError as error:
            return _text(422, str(error))
        if found is None and not self._content.is_built:
            page = f"<!doctype html><meta charset=utf-8><title>Thymio</title><p>{PAGE_BUILD_HINT}</p>"
            return _response(503, page.encode(), TYPES[".html"], {"Cache-Control": "no-store"})
        if found is None:
            return _text(404, "There is no such file.")
        return await self._document(request, found)

    async def _document(self, request: web.BaseRequest, document: Document) -> web.StreamResponse:
        headers = {
            "Cache-Control": f"public, max-age={_HASH_LIFETIME_S}, immutable" if document.is_immutable else "no-cache",
            "Content-Security-Policy": _policy(request.headers.get("Host", ""), self._settings.foxglove_port),
        }
        body, tag = document.body, document.tag
        if document.compressed is not None:
            headers["Vary"] = "Accept-Encoding"
            if _GZIP.search(request.headers.get("Accept-Encoding", "")):
                headers["Content-Encoding"] = "gzip"
                body, tag = document.compressed, f"{document.tag}-gzip"
        headers["ETag"] = f'"{tag}"'
        if _has_tag(request.headers.get("If-None-Match", ""), tag):
            headers.pop("Content-Encoding", None)
            return _response(304, b"", document.media_type, headers)
        if len(body) <= _CHUNK or request.method == "HEAD":
            return _response(200, body, document.media_type, headers)
        headers["Content-Type"] = document.media_type
        response = web.StreamResponse(headers={**_COMMON, **headers})
        response.content_length = len(body)
        await response.prepare(request)
        for begin in range(0, len(body), _CHUNK):
            await response.write(body[begin : begin + _CHUNK])
            await asyncio.sleep(0)
        return response


class _Acceptor:
    """Accepts connections while there are slots."""

    def __init__(self, server: web.Server, connections: Connections, report: Report, log: logging.Logger) -> None:
        self._server = server
        self._connections = connections
        self._report = report
        self._log = log

    async def accept_forever(self, listener: socket) -> None:
        """Accept the connections of a listening socket, until it is cancelled."""
        loop = asyncio.get_running_loop()
        listener.setblocking(False)
        listener.setsockopt(SOL_SOCKET, SO_SNDBUF, SEND_BUFFER)  # accepted sockets inherit it
        listener.listen(BACKLOG)
        while True:
            try:
                accepted, peer = await loop.sock_accept(listener)
            except OSError as error:  # out of file descriptors, or the client has disconnected
                self._report("accept", f"connections cannot be accepted: {error.strerror}")
                await asyncio.sleep(_SWEEP_S)
                continue
            while self._connections.is_full:
                self._report("full", "the maximum number of connections is reached; more have to wait")
                await self._make_room()
            slot = self._connections.add(str(peer[0]))
            try:
                await loop.connect_accepted_socket(partial(self._connection, slot), accepted)
            except OSError:  # the client has disconnected
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
            lingering_time=0,
        )


async def serve(
    listeners: Iterable[socket], content: Content, settings: Settings, report: Report, stop: asyncio.Event
) -> None:
    """Serve on listening sockets, which the server then owns, until `stop` is set."""
    loop = asyncio.get_running_loop()
    loop.set_exception_handler(lambda _loop, context: report(_kind(context), _description(context)))
    connections = Connections(settings.max_connections, loop.time)
    log = logging.getLogger(__name__)
    log.setLevel(logging.CRITICAL)  # invalid requests are not logged; internal errors go to `report`
    with ThreadPoolExecutor(2, "page") as pool:
        page = _Page(content, settings, report, pool)
        server = web.Server(page.answer)

        acceptor = _Acceptor(server, connections, report, log)
        tasks = [loop.create_task(acceptor.accept_forever(listener)) for listener in listeners]
        while not stop.is_set():
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(stop.wait(), _SWEEP_S)
            connections.close_overdue()
        for one in tasks:
            one.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        await server.shutdown(_CLOSE_S)


def _is_ready(descriptor: int, events: int) -> bool:
    """Whether one of these `poll` events is pending for an open socket."""
    poll = select.poll()
    poll.register(descriptor, events)
    return bool(poll.poll(0))


def _response(status: int, body: bytes, media_type: str, headers: Mapping[str, str]) -> web.Response:
    return web.Response(status=status, body=body, headers={**_COMMON, "Content-Type": media_type, **headers})


def _text(status: int, text: str, headers: Mapping[str, str] | None = None) -> web.Response:
    return _response(status, f"{text}\n".encode(), _TEXT, {"Cache-Control": "no-store", **(headers or {})})


def _host_name(host: str) -> str | None:
    """The name or address in a Host header, without brackets and port; None if it is invalid."""
    match = _HOST.fullmatch(host)
    return None if match is None else match["name"].strip("[]").lower()


def _policy(host: str, foxglove_port: int) -> str:
    """The Content-Security-Policy: the page may load from this server and connect to the bridge on the same host."""
    name = _host_name(host)
    # A policy cannot contain an IPv6 address.
    bridge = f"ws://{name}:{foxglove_port} wss://{name}:{foxglove_port}" if name and ":" not in name else "ws: wss:"
    return (
        f"default-src 'self'; script-src 'self'; connect-src 'self' {bridge}; img-src 'self' data: blob:; "
        "style-src 'self' 'unsafe-inline'; object-src 'none'; base-uri 'none'; form-action 'none'; "
        "frame-ancestors 'self'"
    )


def _has_tag(wanted: str, tag: str) -> bool:
    """Whether an If-None-Match header names the tag, weakly compared (RFC 9110 section 13.1.2)."""
    tags = {item.strip().removeprefix("W/") for item in wanted.split(",")}
    return "*" in tags or f'"{tag}"' in tags


def _kind(context: Mapping[str, Any]) -> str:
    return type(context.get("exception")).__name__


def _description(context: Mapping[str, Any]) -> str:
    return f"{context.get('message', 'a connection failed')}: {context.get('exception')}"
