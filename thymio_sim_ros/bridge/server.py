"""The asyncio part of the bridge: sockets around the switchboard, on the current API of `websockets`.

Everything runs in one event loop except commands and published messages, which the calling thread writes to the
sockets itself. A fair lock therefore guards the switchboard and the send queues; no thread blocks while it holds the
lock. No client delays another one: each has its own `ClientSendQueue`, and while the event sink is full the server
stops reading from the client that fills it.
"""

from __future__ import annotations

import asyncio
import itertools
import logging
import time
from collections.abc import Iterable, Sequence
from socket import socket
from typing import cast

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.exceptions import ConnectionClosed
from websockets.frames import CloseCode

from thymio_sim_ros.bridge.client_send_queue import ClientSendQueue, SendFunction
from thymio_sim_ros.bridge.fair_lock import FairLock
from thymio_sim_ros.bridge.framing import framed
from thymio_sim_ros.bridge.handshake import HandshakeCheck, select_subprotocol
from thymio_sim_ros.bridge.protocol.constants import StatusLevel
from thymio_sim_ros.bridge.protocol.errors import FrameError
from thymio_sim_ros.bridge.protocol.messages import (
    ClientMessage,
    ServerMessage,
    ServiceCallFailure,
    ServiceRequest,
    Status,
    Time,
    Unsubscribe,
)
from thymio_sim_ros.bridge.protocol.wire import decode_client, encode_server
from thymio_sim_ros.bridge.rosbridge import frames
from thymio_sim_ros.bridge.settings import REFUSED_FACTOR, EventSink, ServerSettings
from thymio_sim_ros.bridge.switchboard.events import (
    Command,
    Data,
    Event,
    RemoveChannels,
    RosbridgeJoined,
    RosbridgeLeft,
    RosbridgeReceived,
)
from thymio_sim_ros.bridge.switchboard.outcome import Delivery
from thymio_sim_ros.bridge.switchboard.subscriptions import Routes
from thymio_sim_ros.bridge.switchboard.switchboard import Switchboard
from thymio_sim_ros.bridge.throttle import Throttle
from thymio_sim_ros.bridge.transport import SLICE_S, ConnectionMaker, SharedConnection

__all__ = ["BACKLOG", "BridgeServer"]

_FLUSH_PERIOD_S = 0.01
"""Time between attempts to send kept data frames."""
_FULL_PAUSE_S = 0.005
"""Time between checks whether the event sink accepts events again."""
_CLOSE_S = 0.3
"""Time that clients have to answer the closing handshake."""
BACKLOG = 128
"""Connections that the kernel queues until they are accepted."""
_ACCEPTED_AT_ONCE = 4
"""Connections accepted in one iteration of the loop. A handshake takes 3 ms, during which no client is served."""
_NO_SENDERS: tuple[Routes, tuple[SendFunction, ...]] = ((), ())
_TIME_SLOT = -1
"""Key of the newest time in a send queue; no subscription has this ID."""


class BridgeServer:
    """A Foxglove server on its listening sockets.

    `execute` and `publish` may be called from any thread until `close`; the other methods belong to the thread of the
    event loop.
    """

    def __init__(self, board: Switchboard, sink: EventSink, settings: ServerSettings | None = None) -> None:
        self._board = board
        self._routed, self._retained = board.subscriptions.routed, board.subscriptions.retained
        self._senders: dict[int, tuple[Routes, tuple[SendFunction, ...]]] = {}
        """Send functions by channel, with the routes they were made for; made again when the routes change."""
        self._sink = sink
        self._settings = settings or ServerSettings()
        self._log = logging.getLogger(__name__)
        self._queues: dict[int, ClientSendQueue] = {}
        self._client_ids = itertools.count(1)
        self._handshakes = HandshakeCheck(self._settings.tokens, self._settings.allowed_origins, self._log)
        self._flush_is_due = False
        self._loop: asyncio.AbstractEventLoop
        self._servers: list[Server] = []
        self._lock = FairLock()
        """Guards the switchboard and the send queues."""
        self._frames: dict[type, tuple[ServerMessage, bytes]] = {}
        """Encoded frames of the first messages to new clients, by type."""
        self._throttle: Throttle
        self._is_limit_logged = False
        self._is_closing = False
        self._connections = ConnectionMaker(2 * self._settings.max_clients, self._log_client_limit)

    async def start(self, listeners: Iterable[socket]) -> None:
        """Serve on bound sockets; the server takes ownership of them."""
        self._loop = asyncio.get_running_loop()
        self._throttle = Throttle(SLICE_S)
        settings = self._settings
        # `websockets` logs each rejected handshake with a traceback; `HandshakeCheck` logs the ones that matter.
        log = logging.getLogger(f"{__name__}.websockets")
        log.setLevel(logging.CRITICAL)
        for listener in listeners:
            server = await serve(
                self._serve_client,
                sock=listener,
                ssl=settings.tls,
                create_connection=cast("type[ServerConnection]", self._connections),
                select_subprotocol=select_subprotocol,
                process_request=self._handshakes.check,
                compression=None,
                server_header=None,
                max_size=REFUSED_FACTOR * settings.max_message_size,
                ping_interval=settings.ping_interval_s,
                ping_timeout=settings.ping_timeout_s,
                close_timeout=_CLOSE_S,
                backlog=_ACCEPTED_AT_ONCE,
                logger=log,
            )
            listener.listen(BACKLOG)  # the kernel may queue more connections than are accepted in one iteration
            self._servers.append(server)

    async def close(self) -> None:
        """Close all connections; abort those that do not answer within `_CLOSE_S`."""
        self._is_closing = True
        for server in self._servers:
            server.close()
        closed = asyncio.gather(*(server.wait_closed() for server in self._servers))
        await asyncio.wait([closed], timeout=_CLOSE_S)
        for queue in self._queues.values():
            queue.abort()
        await closed

    @property
    def client_count(self) -> int:
        """Connected clients."""
        return len(self._queues)

    def execute(self, command: Command) -> None:
        """Execute a command of the data source; from any thread."""
        with self._lock:
            try:
                self._deliver(self._board.apply(command))
            except Exception:
                # An internal error must not end the calling thread; deliveries not made yet are lost.
                self._log.exception("internal error (please report): %s failed", type(command).__name__)
            if isinstance(command, RemoveChannels):
                self._senders.clear()

    def publish(self, channel_id: int, time_ns: int, payload: bytes) -> None:
        """Send a message to all subscribers of a channel; from any thread. Hot path."""
        self._lock.acquire()
        try:
            routes = self._routed.get(channel_id)
            if channel_id in self._retained.by_channel:
                self._retained.add(Data(channel_id, time_ns, payload))
            if routes is None:
                return
            known, senders = self._senders.get(channel_id, _NO_SENDERS)
            if known is not routes:  # routes are immutable: another object means other subscriptions
                senders = tuple(self._queues[client].sender(subscription_id) for client, subscription_id in routes)
                self._senders[channel_id] = (routes, senders)
            for send in senders:
                if not send(time_ns, payload):
                    self._schedule_flush()
        except Exception:
            self._log.exception("internal error (please report): a message of channel %d failed", channel_id)
        finally:
            self._lock.release()

    def send(self, client: int, messages: Iterable[str | bytes], slot: int | None = None) -> None:
        """Send messages to a rosbridge client, if it is connected; from any thread.

        With a `slot`, a client that is slow gets only the newest messages of that number, all or none.
        """
        frame = b"".join(map(framed, messages))
        with self._lock:
            queue = self._queues.get(client)
            if queue is None:
                return
            if slot is None:
                queue.send_control(frame)
            elif not queue.send_data(slot, frame):
                self._schedule_flush()

    def _schedule_flush(self) -> None:
        if not self._flush_is_due:
            self._flush_is_due = True
            self._loop.call_soon_threadsafe(self._flush_soon)

    def _deliver(self, deliveries: Sequence[Delivery]) -> None:
        for delivery in deliveries:
            frame = framed(encode_server(delivery.message))
            for client in delivery.clients:
                if not isinstance(delivery.message, Time):
                    self._queues[client].send_control(frame)
                elif not self._queues[client].send_data(_TIME_SLOT, frame):
                    self._schedule_flush()

    def _flush_soon(self) -> None:
        self._loop.call_later(_FLUSH_PERIOD_S, self._flush)

    def _flush(self) -> None:
        with self._lock:
            for queue in self._queues.values():
                queue.flush()
            self._flush_is_due = any(queue.has_backlog for queue in self._queues.values())
        if self._flush_is_due:
            self._flush_soon()

    async def _serve_client(self, connection: ServerConnection) -> None:
        assert isinstance(connection, SharedConnection)
        if len(self._queues) >= self._settings.max_clients:
            self._log_client_limit()
            await connection.close(CloseCode.TRY_AGAIN_LATER, "too many clients")
            return
        if connection.role is None:
            await self._handshakes.reject(connection)
            return
        client = next(self._client_ids)
        queue = ClientSendQueue(connection, self._settings.buffer_limit)
        began_s = time.thread_time()
        with self._lock:
            self._queues[client] = queue
            if not connection.is_rosbridge:
                for message in self._board.join(client, connection.role):
                    queue.send_control(self._handshake_frame(message))
        if connection.is_rosbridge:
            self._sink.post(RosbridgeJoined(client, connection.role))
        self._is_limit_logged = self._is_limit_logged and len(self._queues) >= self._settings.max_clients
        try:
            await self._throttle.pause(time.thread_time() - began_s)
            await self._read(client, connection)
        except ConnectionClosed:
            pass  # a lost connection is handled like a closed one
        finally:
            with self._lock:
                del self._queues[client]
                self._senders.clear()  # they refer to the removed queue
                events = [RosbridgeLeft(client)] if connection.is_rosbridge else self._board.leave(client)
            self._post_events(events)

    async def _read(self, client: int, connection: SharedConnection) -> None:
        """Process messages of a client until it disconnects."""
        spent = self._throttle.client()
        receive = self._receive_rosbridge if connection.is_rosbridge else self._receive
        async for frame in connection:
            if self._is_closing:
                return
            with spent.measured():
                receive(client, frame)
            while self._sink.is_full(client) and not self._is_closing:
                await asyncio.sleep(_FULL_PAUSE_S)
            await spent.pause_if_busy()

    def _handshake_frame(self, message: ServerMessage) -> bytes:
        """Encode one of the first messages to a client; cached, because 1500 topics are 2 MB for each client."""
        known = self._frames.get(type(message))
        if known is None or known[0] is not message:
            known = self._frames[type(message)] = message, framed(encode_server(message))
        return known[1]

    def _log_client_limit(self) -> None:
        """Log that the limit of clients is reached; once, until there are fewer clients."""
        if not self._is_limit_logged:
            self._is_limit_logged = True
            self._log.warning("%d clients are connected: more are rejected", self._settings.max_clients)

    def _receive(self, client: int, frame: str | bytes) -> None:
        try:
            message = self._decode(client, frame)
        except FrameError as error:
            self._answer(client, Status(StatusLevel.ERROR, str(error)))
            return
        with self._lock:
            outcome = self._board.receive(client, message)
            if isinstance(message, Unsubscribe):
                for subscription_id in message.subscription_ids:
                    self._queues[client].discard(subscription_id)
            self._deliver(outcome.deliveries)
        self._post_events(outcome.events)

    def _receive_rosbridge(self, client: int, frame: str | bytes) -> None:
        if len(frame) <= self._settings.max_message_size:
            self._sink.post(RosbridgeReceived(client, frame))
        else:
            self.send(client, [frames.as_json(frames.status("error", str(self._too_long(frame))))])

    def _too_long(self, frame: str | bytes) -> FrameError:
        return FrameError(
            "frame", f"at most {self._settings.max_message_size} bytes (max_message_size)", str(len(frame))
        )

    def _decode(self, client: int, frame: str | bytes) -> ClientMessage:
        """Decode a frame. Raises FrameError, also for one that is too long; a service call gets its failure as well."""
        if len(frame) <= self._settings.max_message_size:
            return decode_client(frame)
        error = self._too_long(frame)
        if isinstance(frame, bytes):  # decoding copies no more than the payload
            request = decode_client(frame)
            if isinstance(request, ServiceRequest):
                self._answer(client, ServiceCallFailure(request.service_id, request.call_id, str(error)))
        raise error

    def _answer(self, client: int, message: ServerMessage) -> None:
        with self._lock:
            self._queues[client].send_control(framed(encode_server(message)))

    def _post_events(self, events: Iterable[Event]) -> None:
        for event in events:
            self._sink.post(event)
