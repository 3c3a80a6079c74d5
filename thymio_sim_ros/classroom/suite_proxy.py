"""Passes requests on to the suites of pupils: HTTP with bodies as streams, and upgrades to WebSocket as tunnels.

After the answer 101 nothing is parsed any more: bytes that arrive on one connection are written to the other one, and a
connection that cannot be written pauses reading of the other. A suite therefore sees a page that does not read as it
sees any slow client.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable

import aiohttp
from aiohttp import hdrs, web
from multidict import CIMultiDict
from yarl import URL

from thymio_sim_ros.access.visitor import FORWARDED, Visitor
from thymio_sim_ros.web.http_connections import COMMON_HEADERS, start_answer, start_stream, text_response

__all__ = ["SuiteProxy", "Tunnel", "is_upgrade"]

_CONNECT_S = 5.0
_IDLE_S = 5.0
"""Time that a connection to a suite is kept for another request; suites close theirs later."""
_CLOSE_S = 5.0
"""Time in which a visitor must have read the rest of what a suite that has closed its connection has sent."""
_RETRY_AFTER = {"Retry-After": "2", "Cache-Control": "no-store"}

_HOP_BY_HOP = frozenset(
    {
        *("connection", "keep-alive", "proxy-authenticate", "proxy-authorization", "proxy-connection", "te"),
        *("trailer", "transfer-encoding", "upgrade"),
    }
)
"""Headers about one connection (RFC 9110 section 7.6.1)."""
_OWN = frozenset({"host", "cookie", "forwarded"})
"""Headers of a request that a suite does not get: it sets no cookies, so that they are those of others."""
_FROM_SUITE = frozenset(name.lower() for name in (*COMMON_HEADERS, "Date", "Content-Length"))
"""Headers of an answer that this server writes itself."""


class SuiteProxy:
    """A client of all suites. Only for the thread of the event loop."""

    def __init__(self) -> None:
        self._session = aiohttp.ClientSession(
            connector=aiohttp.TCPConnector(limit=0, keepalive_timeout=_IDLE_S),
            cookie_jar=aiohttp.DummyCookieJar(),
            timeout=aiohttp.ClientTimeout(total=None, sock_connect=_CONNECT_S),
            skip_auto_headers=(hdrs.USER_AGENT, hdrs.ACCEPT, hdrs.ACCEPT_ENCODING, hdrs.CONTENT_TYPE),
            auto_decompress=False,
            trust_env=False,
        )

    async def close(self) -> None:
        """Close the connections to suites."""
        await self._session.close()

    async def forward(
        self, request: web.BaseRequest, target: str, port: int, visitor: Visitor, name: str
    ) -> web.StreamResponse:
        """The answer of the suite at a port to a request for `target` (path and query); 503 if it does not answer.

        `name` of the pupil is for the text of that answer.
        """
        if not request.body_exists:
            start_answer(request)
        url = URL(f"http://127.0.0.1:{port}{target}", encoded=True)
        try:
            answer = await self._session.request(
                request.method,
                url,
                headers=_headers(request, visitor),
                data=request.content if request.body_exists else None,
                allow_redirects=False,
            )
        except (aiohttp.ClientError, TimeoutError):
            start_answer(request)
            text = f"The simulator of {name} does not answer. It starts again by itself: try again in some seconds."
            response = text_response(503, text, _RETRY_AFTER)
            response.force_close()  # the rest of a body may still arrive
            return response
        try:
            start_answer(request)
            return await (_join if answer.status == 101 else _copy)(request, answer)
        finally:
            answer.close()  # its connection is kept if all of the answer has been read


def is_upgrade(request: web.BaseRequest) -> bool:
    """Whether a request asks for a WebSocket."""
    wanted = {item.strip().lower() for item in request.headers.get("Connection", "").split(",")}
    return "upgrade" in wanted and request.headers.get("Upgrade", "").lower() == "websocket"


def _headers(request: web.BaseRequest, visitor: Visitor) -> CIMultiDict[str]:
    """The headers of a request for a suite: those of the visitor, except what others than proxies may not send."""
    named = {item.strip().lower() for item in request.headers.get("Connection", "").split(",")}
    dropped = _HOP_BY_HOP | _OWN | named
    headers = CIMultiDict(
        (name, value)
        for name, value in request.headers.items()
        if name.lower() not in dropped and not name.lower().startswith(FORWARDED)
    )
    if is_upgrade(request):
        headers["Connection"], headers["Upgrade"] = "Upgrade", "websocket"
    headers["X-Forwarded-For"] = visitor.address
    headers["X-Forwarded-Proto"] = visitor.scheme
    headers["X-Forwarded-Prefix"] = visitor.prefix
    if visitor.host:
        headers["X-Forwarded-Host"] = visitor.host
    return headers


async def _copy(request: web.BaseRequest, answer: aiohttp.ClientResponse) -> web.StreamResponse:
    """Send a suite's answer as it arrives."""
    response = web.StreamResponse(status=answer.status, headers=_answer_headers(answer))
    response.content_length = answer.content_length
    if answer.content_length is None:
        start_stream(request)
    await response.prepare(request)
    try:
        async for chunk in answer.content.iter_any():
            await response.write(chunk)
    except aiohttp.ClientError:  # the suite has ended: only the end of the connection says so now
        if request.transport is not None:
            request.transport.abort()
    return response


async def _join(request: web.BaseRequest, answer: aiohttp.ClientResponse) -> web.StreamResponse:
    """Tunnel the connections of a visitor and a suite that has accepted an upgrade, until one of them ends."""
    headers = _answer_headers(answer)
    headers["Connection"], headers["Upgrade"] = "Upgrade", "websocket"
    response = web.StreamResponse(status=101, headers=headers)
    start_stream(request)
    await response.prepare(request)
    protocol, visitor = answer.connection and answer.connection.protocol, request.transport
    if protocol is None or protocol.transport is None or visitor is None:
        raise ConnectionResetError("a connection was closed during the upgrade")
    early = _Early()
    protocol.set_parser(early, early)  # gets what has arrived after the head of the answer
    visitor.write(early.data)
    await Tunnel.open(visitor, protocol.transport)
    return response


def _answer_headers(answer: aiohttp.ClientResponse) -> CIMultiDict[str]:
    dropped = _HOP_BY_HOP | _FROM_SUITE
    kept = [(name, value) for name, value in answer.headers.items() if name.lower() not in dropped]
    return CIMultiDict([*COMMON_HEADERS.items(), *kept])


class _Early:
    """Takes the bytes of a suite that arrive before the tunnel is open, as aiohttp passes them to a parser."""

    def __init__(self) -> None:
        self.data = b""

    def feed_data(self, data: bytes) -> tuple[bool, bytes]:
        self.data += data
        return False, b""

    def feed_eof(self) -> None:
        pass


class Tunnel(asyncio.Protocol):
    """One connection of a pair: what arrives on it is written to the other one."""

    def __init__(self, other: asyncio.Transport, lost: Callable[[Exception | None], object]) -> None:
        """`lost` is called when this connection has ended."""
        self._other, self._lost = other, lost

    @classmethod
    def open(cls, visitor: asyncio.Transport, suite: asyncio.Transport) -> asyncio.Future[None]:
        """Join two connections: the end of one closes the other. The future is done when that of the visitor ends."""
        ended: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        before = visitor.get_protocol()

        def end(error: Exception | None) -> None:
            if not ended.done():  # the task that waits is cancelled with the connection
                ended.set_result(None)
            before.connection_lost(error)

        visitor.set_protocol(cls(suite, end))
        suite.set_protocol(cls(visitor, suite.get_protocol().connection_lost))
        if suite.is_closing():
            visitor.close()
        return ended

    def data_received(self, data: bytes) -> None:
        """Write bytes to the other connection."""
        self._other.write(data)

    def pause_writing(self) -> None:
        """Read no more from the other connection: the peer of this one does not read."""
        self._other.pause_reading()

    def resume_writing(self) -> None:
        """Read from the other connection again."""
        self._other.resume_reading()

    def connection_lost(self, exc: Exception | None) -> None:
        """Close the other connection once its peer has read what is pending, or after a while."""
        self._other.close()
        asyncio.get_running_loop().call_later(_CLOSE_S, self._other.abort)
        self._lost(exc)
