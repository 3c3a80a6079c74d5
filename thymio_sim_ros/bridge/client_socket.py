"""A client on a WebSocket of aiohttp: what arrives is iterated over, what waits in its queue is sent."""

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
"""Messages of a client, or for a client, after which others are served: aiohttp does not wait in between."""


class ClientSocket:
    """The open WebSocket of a client. Only for the thread of the event loop."""

    def __init__(self, socket: web.WebSocketResponse, writer: AbstractStreamWriter) -> None:
        """Only for `accept`."""
        self.response = socket
        """The answer to the client's request."""
        self._writer = writer
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
        assert writer is not None
        return cls(socket, writer)

    @property
    def protocol(self) -> str | None:
        """The sub-protocol, None without one."""
        return self.response.ws_protocol

    def send_from(self, queue: ClientSendQueue) -> None:
        """Send the messages of a queue from now on, as fast as the client reads."""
        self._sending = asyncio.create_task(self._send_all(queue))

    async def messages(self, queue: ClientSendQueue) -> AsyncIterator[Message]:
        """The messages that arrive, until the connection ends. Pings are answered by the queue."""
        for number in itertools.count(1):
            frame = await self.response.receive()
            if frame.type is WSMsgType.TEXT or frame.type is WSMsgType.BINARY:
                yield frame.data
            elif frame.type is WSMsgType.PING:
                queue.put_control(Pong(frame.data))
            elif frame.type is not WSMsgType.PONG:
                return
            if number % _BATCH == 0:
                await asyncio.sleep(0)

    async def send(self, message: Message) -> None:
        """Send a message at once, beside a queue."""
        if isinstance(message, Pong):
            await self.response.pong(message)
        elif isinstance(message, bytes):
            await self.response.send_bytes(message)
        else:
            await self.response.send_str(message)

    async def close(self, code: int, reason: str = "") -> None:
        """Close the connection; a client that does not answer is disconnected soon."""
        await self.response.close(code=code, message=reason.encode())

    def stop_sending(self) -> None:
        """Send nothing more from the queue; a second call has no effect."""
        if self._sending is not None:
            self._sending.cancel()

    async def _send_all(self, queue: ClientSendQueue) -> None:
        with contextlib.suppress(ConnectionError):  # `messages` ends as well
            for number in itertools.count(1):
                while (message := queue.pop()) is None:
                    await queue.wait()
                await self.send(message)
                if queue.buffered():
                    await self._writer.drain()
                if number % _BATCH == 0:
                    await asyncio.sleep(0)
