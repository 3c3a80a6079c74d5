"""A server and real clients on loopback, in one event loop."""

from __future__ import annotations

import asyncio
import base64
import os
import socket
import ssl
from collections.abc import AsyncIterator, Callable, Coroutine, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import asynccontextmanager
from dataclasses import replace
from typing import Any, TypeVar

from websockets.asyncio.client import ClientConnection, connect
from websockets.typing import Origin, Subprotocol

from tests.patience import PATIENCE_S, PROGRAM_S
from thymio_sim_ros.bridge import SUBPROTOCOLS, BridgeServer, Capability, ServerInfo, ServerSettings
from thymio_sim_ros.bridge.listening import listen
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol import wire
from thymio_sim_ros.bridge.switchboard import events as ev
from thymio_sim_ros.bridge.switchboard.switchboard import Switchboard
from thymio_sim_ros.bridge.websocket import BridgeSockets
from thymio_sim_ros.web.application import Application
from thymio_sim_ros.web.http_connections import HttpConnections

T = TypeVar("T")

CHANNEL = ms.Channel(10, "/t", "cdr", "std_msgs/msg/String", "string data", "ros2msg")


def run(scenario: Coroutine[Any, Any, T]) -> T:
    """Run a scenario in its own thread and return its result: browser tests leave a running loop in this thread.

    The loop is that of the server on each system.
    """
    with ThreadPoolExecutor(1) as pool, asyncio.Runner(loop_factory=asyncio.SelectorEventLoop) as runner:
        return pool.submit(runner.run, scenario).result()


class Sink:
    """Records the events of a server, and answers requests for parameters."""

    def __init__(self) -> None:
        self.events: list[ev.Event] = []
        self.full = False
        self.answer: Callable[[ev.Command], None] = lambda command: None
        self._arrived = asyncio.Event()

    def post(self, event: ev.Event) -> None:
        """Record an event."""
        if isinstance(event, ev.ParametersRequested):
            self.answer(ev.SendParameters(event.client, event.names or None, event.request_id))
            return
        self.events.append(event)
        self._arrived.set()

    def is_full(self, client: int) -> bool:
        """Whether the sink reports that it is full."""
        return self.full

    async def until(self, condition: Callable[[list[ev.Event]], bool]) -> None:
        """Wait until the events satisfy the condition."""
        async with asyncio.timeout(PATIENCE_S):
            while not condition(self.events):
                self._arrived.clear()
                await self._arrived.wait()


class LoopIterations:
    """Counts iterations of the running event loop."""

    def __init__(self) -> None:
        self.count = 0
        self._task = asyncio.create_task(self._run())

    async def _run(self) -> None:
        while True:
            await asyncio.sleep(0)
            self.count += 1

    def stop(self) -> None:
        """Stop counting."""
        self._task.cancel()


class Client:
    """A real client, which sends and receives messages."""

    def __init__(self, connection: ClientConnection) -> None:
        self.connection = connection

    async def send(self, *messages: ms.ClientMessage) -> None:
        """Send messages."""
        for message in messages:
            await self.connection.send(wire.encode_client(message))

    async def next(self, kind: type[T]) -> T:
        """The next message of this kind; others are skipped."""
        async with asyncio.timeout(PATIENCE_S):
            while True:
                message = wire.decode_server(await self.connection.recv())
                if isinstance(message, kind):
                    return message

    async def subscribe(self, subscription: int, channel: int = CHANNEL.id) -> None:
        """Subscribe, and wait until the server has processed it."""
        await self.send(ms.Subscribe((ms.Subscription(subscription, channel),)))
        await self.settle()

    async def settle(self) -> None:
        """Wait until the server has processed all sent messages."""
        await self.send(ms.GetParameters((), "settle"))
        while (await self.next(ms.ParameterValues)).id != "settle":
            pass


class Bridge:
    """A running server with one channel."""

    def __init__(
        self, server: BridgeServer, sink: Sink, port: int, connections: HttpConnections, sockets: BridgeSockets
    ) -> None:
        self.server = server
        self.close = sockets.close
        self.sink = sink
        self.port = port
        self.slots = connections.slots

    @property
    def url(self) -> str:
        """Address for clients."""
        return f"ws://127.0.0.1:{self.port}"

    @asynccontextmanager
    async def client(
        self,
        *,
        subprotocols: Sequence[Subprotocol] = SUBPROTOCOLS,
        origin: str | None = None,
        query: str = "",
        headers: dict[str, str] | None = None,
    ) -> AsyncIterator[Client]:
        """A connected client."""
        async with connect(
            self.url + query,
            subprotocols=subprotocols,
            origin=None if origin is None else Origin(origin),
            additional_headers=headers,
            max_size=None,
            ping_interval=None,
        ) as connection:
            yield Client(connection)

    def publish(self, *payloads: bytes) -> None:
        """Publish on the channel, times 0, 1, 2, …"""
        for time_ns, payload in enumerate(payloads):
            self.server.publish(CHANNEL.id, time_ns, payload)

    async def flood(self, count: int, payload: Callable[[int], bytes]) -> None:
        """Publish many messages, and let the loop process each before the next one."""
        for number in range(count):
            self.publish(payload(number))
            await asyncio.sleep(0)

    async def until(self, condition: Callable[[], bool]) -> None:
        """Run the event loop until the condition is true."""
        async with asyncio.timeout(PATIENCE_S):
            while not condition():
                await asyncio.sleep(0)


@asynccontextmanager
async def bridge(
    settings: ServerSettings | None = None, *, max_connections: int = 256, tls: ssl.SSLContext | None = None
) -> AsyncIterator[Bridge]:
    """A server that ends with the block. It does not ping its clients: the time of a pong depends on the machine."""
    sink = Sink()
    board = Switchboard(ServerInfo("test", tuple(Capability), ("cdr", "json")))
    loop = asyncio.get_running_loop()
    server = BridgeServer(board, sink, loop, replace(settings or ServerSettings(), heartbeat_s=PROGRAM_S))
    sink.answer = server.execute
    application = Application()
    sockets = BridgeSockets(server)
    application.websockets["/"] = sockets.handle
    problems: list[str] = []
    connections = HttpConnections(application.answer, max_connections, lambda about, text: problems.append(text), loop)
    (listener,) = listen("127.0.0.1", 0)
    connections.accept([listener], tls)
    server.execute(ev.AddChannels((CHANNEL,)))
    try:
        yield Bridge(server, sink, listener.getsockname()[1], connections, sockets)
    finally:
        await sockets.close()
        await connections.close()
        listener.close()
    assert [text for text in problems if "internal error" in text] == []


def masked_frame(message: ms.ClientMessage) -> bytes:
    """The WebSocket frame of a short message of a client, masked with zeros."""
    frame = wire.encode_client(message)
    body, opcode = (frame.encode(), 0x81) if isinstance(frame, str) else (frame, 0x82)
    assert len(body) < 126
    return bytes([opcode, 0x80 | len(body), 0, 0, 0, 0]) + body


class StalledClient:
    """A client on a plain socket, which reads only in `connect` and `next`, so that nothing is read in advance."""

    def __init__(self, port: int) -> None:
        self._socket = socket.socket()
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        self._socket.setblocking(False)
        self._port = port
        self._read = bytearray()

    async def connect(self) -> None:
        """Make the handshake; read only its headers."""
        loop = asyncio.get_running_loop()
        await loop.sock_connect(self._socket, ("127.0.0.1", self._port))
        key = base64.b64encode(os.urandom(16)).decode()
        request = (
            "GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: {key}\r\n"
            f"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: {SUBPROTOCOLS[0]}\r\n\r\n"
        )
        await loop.sock_sendall(self._socket, request.encode())
        while b"\r\n\r\n" not in self._read:
            self._read += await loop.sock_recv(self._socket, 1)
        self._read.clear()

    async def say(self, message: ms.ClientMessage) -> None:
        """Send one short message."""
        await asyncio.get_running_loop().sock_sendall(self._socket, masked_frame(message))

    async def next(self, kind: type[T]) -> T:
        """Read until the next message of this kind."""
        async with asyncio.timeout(PATIENCE_S):
            while True:
                message = await self._next()
                if isinstance(message, kind):
                    return message

    def abort(self) -> None:
        """Close the socket without a closing handshake."""
        self._socket.close()

    async def _next(self) -> ms.ServerMessage:
        head = await self._exactly(2)
        size = head[1]
        if size == 126:
            size = int.from_bytes(await self._exactly(2), "big")
        elif size == 127:
            size = int.from_bytes(await self._exactly(8), "big")
        body = await self._exactly(size)
        return wire.decode_server(body.decode() if head[0] == 0x81 else body)

    async def _exactly(self, size: int) -> bytes:
        while len(self._read) < size:
            data = await asyncio.get_running_loop().sock_recv(self._socket, 1 << 16)
            assert data, "the server closed the connection"
            self._read += data
        taken = bytes(self._read[:size])
        del self._read[:size]
        return taken
