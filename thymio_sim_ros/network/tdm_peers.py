"""Connections of the device manager: one class for TCP, one for WebSocket, with the same methods."""

from __future__ import annotations

import asyncio
import ipaddress
import logging
from collections.abc import AsyncIterator, Awaitable, Callable, Sequence
from http import HTTPStatus
from socket import socket
from typing import Protocol, cast

from websockets.asyncio.server import Server, ServerConnection, broadcast, serve
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response

from thymio_sim_ros.bridge.origin_policy import is_allowed
from thymio_sim_ros.bridge.transport import ConnectionMaker
from thymio_sim_ros.network.tdm.protocol.codec import MAX_MESSAGE_BYTES, StreamReader, framed
from thymio_sim_ros.network.tdm.protocol.errors import TdmFrameError

__all__ = ["Peer", "Report", "TcpPeer", "WebSocketPeer", "is_this_computer", "serve_websocket"]

Report = Callable[[str, str], None]
"""Takes a warning: what it is about, so that repetitions can be limited, and the text."""

_READ_BYTES = 1 << 16
_CLOSE_S = 0.3
"""Time that clients have to answer the closing handshake."""


class Peer(Protocol):
    """A connection of a client."""

    address: str

    def buffers(self) -> AsyncIterator[bytes]:
        """The buffers that arrive, until the connection ends. Raises TdmFrameError for a wrong frame."""

    def send(self, buffer: bytes) -> None:
        """Send a buffer, without waiting."""

    @property
    def backlog(self) -> int:
        """Bytes that wait until the client reads."""

    def close(self) -> None:
        """Close the connection after what has been sent."""

    def abort(self) -> None:
        """Close the connection at once."""


class TcpPeer:
    """A client of the TCP port."""

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._reader, self._writer = reader, writer
        peer = writer.get_extra_info("peername")
        self.address = str(peer[0]) if peer else ""

    async def buffers(self) -> AsyncIterator[bytes]:
        """The buffers that arrive, until the connection ends."""
        stream = StreamReader()
        try:
            while data := await self._reader.read(_READ_BYTES):
                for buffer in stream.feed(data):
                    yield buffer
        except OSError:
            pass  # a lost connection is handled like a closed one

    def send(self, buffer: bytes) -> None:
        """Send a buffer in one piece."""
        if not self._writer.is_closing():
            self._writer.write(framed(buffer))

    @property
    def backlog(self) -> int:
        """Bytes that wait until the client reads."""
        return self._writer.transport.get_write_buffer_size()

    def close(self) -> None:
        """Close the connection after what has been sent."""
        self._writer.close()

    def abort(self) -> None:
        """Close the connection at once."""
        self._writer.transport.abort()


class WebSocketPeer:
    """A client of the WebSocket port: each message is a binary frame."""

    def __init__(self, connection: ServerConnection) -> None:
        self._connection = connection
        peer = connection.remote_address
        self.address = str(peer[0]) if peer else ""

    async def buffers(self) -> AsyncIterator[bytes]:
        """The buffers that arrive, until the connection ends."""
        try:
            async for frame in self._connection:
                if isinstance(frame, str):
                    raise TdmFrameError("frame", "a binary frame", "a text")
                yield frame
        except ConnectionClosed:
            pass  # a lost connection is handled like a closed one

    def send(self, buffer: bytes) -> None:
        """Send a buffer as a frame."""
        broadcast((self._connection,), buffer)

    @property
    def backlog(self) -> int:
        """Bytes that wait until the client reads."""
        return self._connection.transport.get_write_buffer_size()

    def close(self) -> None:
        """Close the connection after what has been sent."""
        self._connection.transport.close()

    def abort(self) -> None:
        """Close the connection at once."""
        self._connection.transport.abort()


def is_this_computer(address: str) -> bool:
    """Whether the address of a client is one of this computer's loopback addresses."""
    try:
        number = ipaddress.ip_address(address.partition("%")[0])
    except ValueError:
        return False
    mapped = getattr(number, "ipv4_mapped", None)
    return (mapped or number).is_loopback


async def serve_websocket(
    listener: socket,
    handle: Callable[[Peer], Awaitable[None]],
    allowed_origins: Sequence[str],
    report: Report,
    max_connections: int,
) -> Server:
    """Serve clients on a bound socket, except foreign web pages (`bridge.origin_policy`).

    Pings and parts of messages of one client delay the others no more than its messages do.
    """

    async def handle_connection(connection: ServerConnection) -> None:
        await handle(WebSocketPeer(connection))

    def check_origin(connection: ServerConnection, request: Request) -> Response | None:
        origins, hosts = request.headers.get_all("Origin"), request.headers.get_all("Host")
        origin = origins[-1] if origins else None
        if is_allowed(origin, hosts[-1] if hosts else None, allowed_origins):
            return None
        report("tdm origin", f"web page from {origin:.100} rejected: add it to allowed_origins if it is yours")
        return connection.respond(HTTPStatus.FORBIDDEN, f"Pages from {origin} may not connect; see allowed_origins.\n")

    def report_refused() -> None:
        report("tdm connections", f"{max_connections} connections to port {port}: more are refused")

    port = listener.getsockname()[1]
    log = logging.getLogger(f"{__name__}.websockets")
    log.setLevel(logging.CRITICAL)  # it logs each rejected handshake with a traceback
    return await serve(
        handle_connection,
        sock=listener,
        create_connection=cast("type[ServerConnection]", ConnectionMaker(max_connections, report_refused)),
        process_request=check_origin,
        compression=None,
        server_header=None,
        max_size=MAX_MESSAGE_BYTES,
        close_timeout=_CLOSE_S,
        logger=log,
    )
