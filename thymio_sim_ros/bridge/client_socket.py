"""A client on a WebSocket of aiohttp: what arrives is iterated over, what waits in its queue is sent.

Messages are written to the transport in the iteration of the event loop in which they are queued, as many as it accepts
in one piece. With aiohttp's `send_bytes`, a task would send each of them in a later iteration: twice the delay and, for
bursts, a call of the system for each message.
"""

from __future__ import annotations

import asyncio
import contextlib
import itertools
from collections.abc import AsyncIterator
from http import HTTPStatus

from aiohttp import WSMsgType, web
from aiohttp.abc import AbstractStreamWriter

from thymio_sim_ros.access import RefusedError
from thymio_sim_ros.bridge.client_send_queue import ClientSendQueue, Message, Pong

__all__ = ["ClientSocket"]

_CLOSE_S = 0.3
"""Time that clients have to answer the closing handshake."""
_BATCH = 64
"""Messages of a client after which others are served: aiohttp does not wait in between."""
_PIECE, _TURN = 1 << 16, 1 << 18
"""Bytes that are written at once, and bytes for a client after which others are served."""
_MOST_BUFFERED = 1 << 16
"""Bytes in the transport above which nothing more is written; the queue keeps the newest messages instead."""
_TEXT, _BINARY, _PONG = 0x81, 0x82, 0x8A
"""First byte of a frame that is a whole message (RFC 6455 section 5.2)."""


class ClientSocket:
    """The open WebSocket of a client. Only for the thread of the event loop."""

    def __init__(
        self, socket: web.WebSocketResponse, writer: AbstractStreamWriter, transport: asyncio.Transport
    ) -> None:
        """Only for `accept`."""
        self.response = socket
        """The answer to the client's request."""
        self._writer, self._transport = writer, transport
        transport.set_write_buffer_limits(high=_MOST_BUFFERED)  # where `flush` stops, `drain` waits; with TLS, too
        self._queue: ClientSendQueue | None = None
        self._has_rest = asyncio.Event()
        """Set while messages wait until the client has read others."""
        self._sending: asyncio.Task[None] | None = None

    @classmethod
    async def accept(
        cls, request: web.BaseRequest, *, protocol: str | None = None, max_size: int, heartbeat_s: float
    ) -> ClientSocket:
        """Make the handshake. Raises RefusedError for a request that does not ask for a WebSocket.

        `max_size`: bytes of the longest message that is received; a longer one ends the connection. `heartbeat_s`: time
        without a message after which the client is pinged; it has half of this time to answer.
        """
        if request.headers.get("Upgrade", "").lower() != "websocket":
            raise RefusedError(HTTPStatus.UPGRADE_REQUIRED, "expected a WebSocket: ws://…", {"Upgrade": "websocket"})
        socket = web.WebSocketResponse(
            protocols=() if protocol is None else (protocol,),
            timeout=_CLOSE_S,
            heartbeat=heartbeat_s,
            autoping=False,  # pongs wait in the queue, where they are counted
            compress=False,
            max_msg_size=max_size + 1,
        )
        writer = await socket.prepare(request)
        transport = request.transport
        if writer is None or transport is None:
            raise ConnectionResetError("the client has left during its handshake")
        return cls(socket, writer, transport)

    @property
    def protocol(self) -> str | None:
        """The sub-protocol, None without one."""
        return self.response.ws_protocol

    def send_from(self, queue: ClientSendQueue) -> None:
        """Send the messages of a queue, whose `flush` is that of this socket, from now on."""
        self._queue = queue
        self._sending = asyncio.create_task(self._send_rest())
        self.flush()

    def flush(self) -> None:
        """Write what waits in the queue; what the client does not read fast enough follows later."""
        if (queue := self._queue) is None:
            return
        written = 0
        while written < _TURN and self._transport.get_write_buffer_size() <= _MOST_BUFFERED:
            if not (messages := queue.take(_PIECE)):
                return
            written += self._write(messages)
        if not queue.is_empty:
            self._has_rest.set()

    async def messages(self, queue: ClientSendQueue) -> AsyncIterator[Message]:
        """The messages that arrive, until the connection ends. Pings are answered by the queue."""
        for number in itertools.count(1):
            frame = await self.response.receive()
            if frame.type is WSMsgType.TEXT or frame.type is WSMsgType.BINARY:
                yield frame.data
            elif frame.type is WSMsgType.PING:
                queue.put_control(Pong(frame.data))
                queue.flush()
            elif frame.type is not WSMsgType.PONG:
                return
            if number % _BATCH == 0:
                await asyncio.sleep(0)

    async def send(self, message: str | bytes) -> None:
        """Send a message at once, beside a queue."""
        await (self.response.send_str(message) if isinstance(message, str) else self.response.send_bytes(message))

    async def close(self, code: int, reason: str = "") -> None:
        """Close the connection; a client that does not answer is disconnected soon."""
        await self.response.close(code=code, message=reason.encode())

    def stop_sending(self) -> None:
        """Send nothing more from the queue; a second call has no effect."""
        if self._sending is not None:
            self._sending.cancel()

    def _write(self, messages: list[Message]) -> int:
        """Write messages in one piece; return the number of bytes. They are dropped after the closing frame."""
        if self.response.closed or self._transport.is_closing():
            return sum(map(len, messages))
        parts: list[bytes] = []
        for message in messages:
            payload = message.encode() if isinstance(message, str) else message
            first = _TEXT if isinstance(message, str) else _PONG if isinstance(message, Pong) else _BINARY
            parts += (_head(first, len(payload)), payload)
        self._transport.write(b"".join(parts))
        return sum(map(len, parts))

    async def _send_rest(self) -> None:
        with contextlib.suppress(ConnectionError):  # `messages` ends as well
            while True:
                await self._has_rest.wait()
                self._has_rest.clear()
                await self._writer.drain()
                self.flush()
                await asyncio.sleep(0)


def _head(first: int, size: int) -> bytes:
    """The head of a frame of a server, which is not masked (RFC 6455 section 5.2)."""
    if size < 126:
        return bytes((first, size))
    if size < 1 << 16:
        return bytes((first, 126)) + size.to_bytes(2, "big")
    return bytes((first, 127)) + size.to_bytes(8, "big")
