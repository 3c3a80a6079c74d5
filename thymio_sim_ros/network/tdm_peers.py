"""Connections of the device manager: one class for TCP, one for WebSocket, with the same methods."""

from __future__ import annotations

import asyncio
import ipaddress
from collections.abc import AsyncIterator, Callable
from typing import Protocol

from aiohttp import web

from thymio_sim_ros.access import Visitor
from thymio_sim_ros.bridge.client_send_queue import ClientSendQueue
from thymio_sim_ros.bridge.client_socket import ClientSocket
from thymio_sim_ros.network.tdm.protocol.codec import MAX_MESSAGE_BYTES, StreamReader, framed
from thymio_sim_ros.network.tdm.protocol.errors import TdmFrameError

__all__ = ["Peer", "Report", "TcpPeer", "WebSocketPeer", "accept_websocket", "is_this_computer"]

Report = Callable[[str, str], None]
"""Takes a warning: what it is about, so that repetitions can be limited, and the text."""

_READ_BYTES = 1 << 16
_HEARTBEAT_S = 30.0
"""Time without a message after which a client on a WebSocket is pinged."""


class Peer(Protocol):
    """A connection of a client."""

    visitor: Visitor
    is_direct: bool
    """Whether the address of `visitor` is that of the client; on the port of a page it may be that of a proxy."""

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

    is_direct = True

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._reader, self._writer = reader, writer
        peer = writer.get_extra_info("peername")
        self.visitor = Visitor(str(peer[0]) if peer else "", None)

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
    """A client on a WebSocket: each message is a binary frame."""

    def __init__(
        self,
        socket: ClientSocket,
        transport: asyncio.Transport,
        visitor: Visitor,
        max_unsent: int,
        *,
        is_direct: bool,
    ) -> None:
        """Serve a client whose handshake is complete; `max_unsent`: see `TdmServer`."""
        self.is_direct = is_direct
        self.response = socket.response
        """The answer to the client's request."""
        self._socket, self._transport = socket, transport
        self._queue = ClientSendQueue(
            max_unsent,
            warning=b"",
            buffered=transport.get_write_buffer_size,
            flush=socket.flush,
            abort=transport.abort,
        )
        self.visitor = visitor
        socket.send_from(self._queue)

    async def buffers(self) -> AsyncIterator[bytes]:
        """The buffers that arrive, until the connection ends."""
        try:
            async for message in self._socket.messages(self._queue):
                if isinstance(message, str):
                    raise TdmFrameError("frame", "a binary frame", "a text")
                yield message
        finally:
            self._socket.stop_sending()

    def send(self, buffer: bytes) -> None:
        """Send a buffer as a frame."""
        self._queue.put_control(buffer)
        self._queue.flush()

    @property
    def backlog(self) -> int:
        """Bytes that wait until the client reads."""
        return self._queue.size

    def close(self) -> None:
        """Close the connection after what has been sent."""
        self._transport.close()

    def abort(self) -> None:
        """Close the connection at once."""
        self._transport.abort()


def is_this_computer(address: str) -> bool:
    """Whether the address of a client is one of this computer's loopback addresses."""
    try:
        number = ipaddress.ip_address(address.partition("%")[0])
    except ValueError:
        return False
    mapped = getattr(number, "ipv4_mapped", None)
    return (mapped or number).is_loopback


async def accept_websocket(
    request: web.BaseRequest, visitor: Visitor, max_unsent: int, *, is_direct: bool
) -> WebSocketPeer | None:
    """Make the handshake with a client; None: it has left. Raises RefusedError for one that asks for no WebSocket."""
    socket = await ClientSocket.accept(request, max_size=MAX_MESSAGE_BYTES, heartbeat_s=_HEARTBEAT_S)
    transport = request.transport
    return None if transport is None else WebSocketPeer(socket, transport, visitor, max_unsent, is_direct=is_direct)
