"""The clients of the bridge on WebSockets of aiohttp, from their handshake to their end."""

from __future__ import annotations

import asyncio
import time
from http import HTTPStatus

from aiohttp import WSCloseCode, web

from thymio_sim_ros.access import RefusedError, Role, Visitor
from thymio_sim_ros.bridge.client_send_queue import ClientSendQueue, Message
from thymio_sim_ros.bridge.client_socket import ClientSocket
from thymio_sim_ros.bridge.handshake import WRONG_TOKEN, select_subprotocol
from thymio_sim_ros.bridge.protocol.constants import StatusLevel
from thymio_sim_ros.bridge.protocol.messages import Status
from thymio_sim_ros.bridge.protocol.wire import encode_server
from thymio_sim_ros.bridge.rosbridge import frames
from thymio_sim_ros.bridge.server import BridgeServer
from thymio_sim_ros.bridge.settings import REFUSED_FACTOR

__all__ = ["BridgeSockets"]

_FULL_PAUSE_S = 0.005
"""Time between checks whether the event sink accepts events again."""
_CLOSE_S = 0.3
"""Time that all clients together have to answer the closing handshake."""
# The vendor's clients recognize the first words and show a hint.
_WARNING = "Send buffer limit reached: this connection is slow, only newest messages are sent"


class BridgeSockets:
    """The WebSockets of a bridge. Only for the thread of its event loop."""

    def __init__(self, bridge: BridgeServer) -> None:
        self._bridge = bridge
        self._sockets: set[ClientSocket] = set()
        """Those of its clients."""

    async def handle(self, request: web.BaseRequest, visitor: Visitor) -> web.StreamResponse:
        """Serve a client until it disconnects or the server closes. Raises RefusedError for an invalid handshake."""
        protocol = select_subprotocol(request)
        role, problem = await self._role(visitor)
        settings = self._bridge.settings
        socket = await ClientSocket.accept(
            request,
            protocol=protocol,
            max_size=REFUSED_FACTOR * settings.max_message_size,
            heartbeat_s=settings.heartbeat_s,
        )
        if not self._bridge.has_place():
            await socket.close(WSCloseCode.TRY_AGAIN_LATER, "too many clients")
        elif role is None:
            await socket.send(_access_problem(problem, is_rosbridge=protocol is None))
            await socket.close(WRONG_TOKEN, "wrong or missing token")
        elif request.transport is not None:  # None: the client has left meanwhile
            await self._serve(socket, request.transport, role)
        return socket.response

    async def _role(self, visitor: Visitor) -> tuple[Role | None, str]:
        """The role of a client. Raises RefusedError for one that may not connect.

        A page without a valid token has none: it must be accepted and get the reason, the second value, because
        browsers show it only the close code of an open connection.
        """
        try:
            return await self._bridge.access.admit(visitor), ""
        except RefusedError as error:
            if error.status != HTTPStatus.UNAUTHORIZED or visitor.origin is None:
                raise
            return None, str(error)

    async def close(self) -> None:
        """Close all connections; abort those that do not answer within `_CLOSE_S`."""
        self._bridge.stop()
        closing = [asyncio.create_task(socket.close(WSCloseCode.GOING_AWAY)) for socket in self._sockets]
        if closing:
            _, waiting = await asyncio.wait(closing, timeout=_CLOSE_S)
            for task in waiting:
                task.cancel()
        self._bridge.abort_all()
        while self._sockets:  # their tasks end with their connections
            await asyncio.sleep(0)

    async def _serve(self, socket: ClientSocket, transport: asyncio.Transport, role: Role) -> None:
        bridge, is_rosbridge = self._bridge, socket.protocol is None
        queue = ClientSendQueue(
            bridge.settings.buffer_limit,
            warning=_slow_warning(is_rosbridge=is_rosbridge),
            buffered=transport.get_write_buffer_size,
            flush=socket.flush,
            abort=transport.abort,
        )
        began_s = time.thread_time()
        client = bridge.join(queue, role, is_rosbridge=is_rosbridge)
        joined_s = time.thread_time() - began_s
        self._sockets.add(socket)
        socket.send_from(queue)
        try:
            await bridge.throttle.pause(joined_s)
            await self._read(client, socket, queue)
        finally:
            socket.stop_sending()
            self._sockets.discard(socket)
            bridge.leave(client, is_rosbridge=is_rosbridge)

    async def _read(self, client: int, socket: ClientSocket, queue: ClientSendQueue) -> None:
        """Process messages of a client until it disconnects."""
        bridge, is_rosbridge = self._bridge, socket.protocol is None
        spent = bridge.throttle.client()
        async for message in socket.messages(queue):
            if bridge.is_closing:
                return
            with spent.measured():
                bridge.receive(client, message, is_rosbridge=is_rosbridge)
            while bridge.sink.is_full(client) and not bridge.is_closing:
                await asyncio.sleep(_FULL_PAUSE_S)
            await spent.pause_if_busy()


def _access_problem(text: str, *, is_rosbridge: bool) -> Message:
    if is_rosbridge:
        return frames.as_json(frames.status("error", text, "access"))
    return encode_server(Status(StatusLevel.ERROR, text, "access"))


def _slow_warning(*, is_rosbridge: bool) -> Message:
    if is_rosbridge:
        return frames.as_json(frames.status("warning", _WARNING))
    return encode_server(Status(StatusLevel.WARNING, _WARNING))
