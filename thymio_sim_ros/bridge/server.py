"""The clients of the bridge around the switchboard, without sockets.

Everything runs in one event loop. Commands and published messages come from any thread by a queue, and wake the loop
once for all that wait. No client delays another one: each has its own `ClientSendQueue`, and while the event sink is
full the server stops reading from the client that fills it (`websocket`).
"""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import logging
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Sequence

from thymio_sim_ros.access import AccessCheck, AccessRules, Role
from thymio_sim_ros.access.origins import FOXGLOVE_APPS
from thymio_sim_ros.bridge.client_send_queue import ClientSendQueue, Message
from thymio_sim_ros.bridge.fair_queue import FairQueue
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
from thymio_sim_ros.bridge.protocol.wire import data_head, decode_client, encode_server
from thymio_sim_ros.bridge.report_limiter import ReportLimiter
from thymio_sim_ros.bridge.rosbridge import frames
from thymio_sim_ros.bridge.settings import EventSink, ServerSettings
from thymio_sim_ros.bridge.switchboard.events import (
    Command,
    Data,
    Event,
    RosbridgeJoined,
    RosbridgeLeft,
    RosbridgeReceived,
    SendParameters,
)
from thymio_sim_ros.bridge.switchboard.outcome import Delivery
from thymio_sim_ros.bridge.switchboard.switchboard import Switchboard
from thymio_sim_ros.bridge.throttle import Throttle

__all__ = ["BridgeServer"]

_Work = tuple[int, int, bytes] | Command | Callable[[], None]
"""A message of a channel with its time, a command, or a function to call."""

_SLICE_S = 0.002
"""Processor time of the event loop that one client, or values of parameters, may use before others are served, s."""
_MAX_PENDING = 1000
"""Messages and commands that wait for the event loop; the thread of a further one waits until they are processed."""
_MAX_IDLE = 100
"""Messages and commands that may wait while there are no clients."""
_MAX_WAIT_S = 1.0
"""Longest time that a thread waits for the event loop."""
_TIME_SLOT = -1
"""Key of the newest time in a send queue; no subscription has this ID."""


class BridgeServer:
    """Clients that have joined, with a queue of messages for each.

    `execute`, `publish`, `send` and `client_count` may be used in any thread; the rest belongs to that of the loop.
    """

    def __init__(
        self,
        board: Switchboard,
        sink: EventSink,
        loop: asyncio.AbstractEventLoop,
        settings: ServerSettings | None = None,
    ) -> None:
        self.settings = settings or ServerSettings()
        self.sink = sink
        self.throttle = Throttle(_SLICE_S)
        """Limits the time of busy clients."""
        self._log = logging.getLogger(__name__)
        origins = (*self.settings.allowed_origins, *FOXGLOVE_APPS)
        report = ReportLimiter(lambda text: self._log.warning("%s", text))
        self.access = AccessCheck(AccessRules(self.settings.tokens, allowed_origins=origins), report)
        """Decides who may connect."""
        self.is_closing = False
        self._board, self._loop = board, loop
        self._queues: dict[int, ClientSendQueue] = {}
        self._client_ids = itertools.count(1)
        self._pending: deque[_Work] = deque()
        """What has been posted and not been processed yet."""
        self._values: FairQueue[int, SendParameters] = FairQueue()
        """Requested values of parameters by client: a client that asks for much delays nothing else."""
        self._is_woken = False
        """Whether the loop is going to process `_pending`."""
        self._has_room = threading.Event()
        """Set whenever the loop has processed what was pending."""
        self._frames: dict[type, tuple[ServerMessage, Message]] = {}
        """Encoded frames of the first messages to new clients, by type."""
        self._is_limit_logged = False

    # --- any thread ---

    @property
    def client_count(self) -> int:
        """Connected clients."""
        return len(self._queues)

    def execute(self, command: Command) -> None:
        """Execute a command of the data source."""
        self._post(command)

    def publish(self, channel_id: int, time_ns: int, payload: bytes) -> None:
        """Send a message to all subscribers of a channel."""
        self._post((channel_id, time_ns, payload))

    def send(self, client: int, messages: Iterable[Message], slot: int | None = None) -> None:
        """Send messages to a rosbridge client, if it is connected.

        With a `slot`, a client that is slow gets only the newest messages of that number, all or none.
        """
        given = tuple(messages)

        def put() -> None:
            if client in self._queues:
                queue = self._queues[client]
                queue.put_control(*given) if slot is None else queue.put_data(slot, *given)

        self._post(put)

    def _post(self, work: _Work) -> None:
        self._pending.append(work)
        # Reset before the loop begins to process: what is appended later wakes it again. Without clients, such as most
        # of the time, only the simulated time is posted, and waits for the first one (`join`).
        if not self._is_woken and (self._queues or len(self._pending) > _MAX_IDLE):
            self._is_woken = True
            with contextlib.suppress(RuntimeError):  # the loop has ended
                self._loop.call_soon_threadsafe(self._process)
        if len(self._pending) > _MAX_PENDING and not self.is_closing:
            self._wait_for_room()

    def _wait_for_room(self) -> None:
        """Slow down a thread that publishes faster than clients can be served."""
        if self._is_in_loop():
            self._process()
            return
        self._has_room.clear()
        if len(self._pending) > _MAX_PENDING:
            self._has_room.wait(_MAX_WAIT_S)

    def _is_in_loop(self) -> bool:
        try:
            return asyncio.get_running_loop() is self._loop
        except RuntimeError:  # there is none in this thread
            return False

    # --- the thread of the loop ---

    def _process(self) -> None:
        """Process what was pending at the beginning; what comes meanwhile has woken the loop again."""
        self._is_woken = False
        for _ in range(len(self._pending)):
            work = self._pending.popleft()
            try:
                if isinstance(work, tuple):
                    self._send_data(*work)
                elif callable(work):
                    work()
                elif isinstance(work, SendParameters):
                    self._put_values(work)
                else:
                    self._deliver(self._board.apply(work))
            except Exception:
                # An internal error must not end the loop; deliveries not made yet are lost.
                self._log_failure(work)
        self._flush()
        self._has_room.set()

    def _put_values(self, values: SendParameters) -> None:
        if not self._values:
            self._loop.call_soon(self._send_values)
        self._values.put(values.client, values)

    def _send_values(self) -> None:
        """Send values for `_SLICE_S`, and others in the next iterations of the event loop."""
        end_s = time.thread_time() + _SLICE_S
        while self._values:
            values = self._values.pop()
            try:
                self._deliver(self._board.apply(values))
            except Exception:
                self._log_failure(values)
            if time.thread_time() >= end_s and self._values:
                self._loop.call_soon(self._send_values)
                break
        self._flush()

    def _log_failure(self, work: _Work) -> None:
        self._log.exception("internal error (please report): %s failed", type(work).__name__)

    def _flush(self) -> None:
        """Send what has been queued for all clients."""
        for queue in self._queues.values():
            queue.flush()

    def _send_data(self, channel_id: int, time_ns: int, payload: bytes) -> None:
        """Hot path: no message is created for each subscriber."""
        subscriptions = self._board.subscriptions
        if channel_id in subscriptions.retained.by_channel:
            subscriptions.retained.add(Data(channel_id, time_ns, payload))
        for client, subscription_id in subscriptions.routed.get(channel_id, ()):
            self._queues[client].put_data(subscription_id, data_head(subscription_id, time_ns) + payload)

    def _deliver(self, deliveries: Sequence[Delivery]) -> None:
        for delivery in deliveries:
            frame = encode_server(delivery.message)
            for client in delivery.clients:
                if isinstance(delivery.message, Time):
                    self._queues[client].put_data(_TIME_SLOT, frame)
                else:
                    self._queues[client].put_control(frame)

    def stop(self) -> None:
        """Process no more messages of clients."""
        self.is_closing = True
        self._has_room.set()

    def abort_all(self) -> None:
        """Disconnect all clients."""
        for queue in self._queues.values():
            queue.abort()

    def has_place(self) -> bool:
        """Whether one more client may connect; the first one that may not is logged."""
        is_full = len(self._queues) >= self.settings.max_clients
        if is_full and not self._is_limit_logged:
            self._log.warning("%d clients are connected: more are rejected", self.settings.max_clients)
        self._is_limit_logged = is_full
        return not is_full

    def join(self, queue: ClientSendQueue, role: Role, *, is_rosbridge: bool) -> int:
        """Add a client; return its number."""
        client = next(self._client_ids)
        self._queues[client] = queue  # before what is pending is processed: what is posted now wakes the loop
        self._process()
        if is_rosbridge:
            self.sink.post(RosbridgeJoined(client, role))
        else:
            for message in self._board.join(client, role):
                queue.put_control(self._handshake_frame(message))
        return client

    def leave(self, client: int, *, is_rosbridge: bool) -> None:
        """Remove a client."""
        del self._queues[client]
        self._post_events([RosbridgeLeft(client)] if is_rosbridge else self._board.leave(client))

    def receive(self, client: int, frame: Message, *, is_rosbridge: bool) -> None:
        """Process a message of a client."""
        if is_rosbridge:
            self._receive_rosbridge(client, frame)
        else:
            self._receive_foxglove(client, frame)
        self._flush()

    def _receive_foxglove(self, client: int, frame: Message) -> None:
        try:
            message = self._decode(client, frame)
        except FrameError as error:
            self._answer(client, Status(StatusLevel.ERROR, str(error)))
            return
        outcome = self._board.receive(client, message)
        if isinstance(message, Unsubscribe):
            for subscription_id in message.subscription_ids:
                self._queues[client].discard(subscription_id)
        self._deliver(outcome.deliveries)
        self._post_events(outcome.events)

    def _receive_rosbridge(self, client: int, frame: Message) -> None:
        if len(frame) <= self.settings.max_message_size:
            self.sink.post(RosbridgeReceived(client, frame))
        else:
            self._queues[client].put_control(frames.as_json(frames.status("error", str(self._too_long(frame)))))

    def _handshake_frame(self, message: ServerMessage) -> Message:
        """Encode one of the first messages to a client; cached, because 1500 topics are 2 MB for each client."""
        known = self._frames.get(type(message))
        if known is None or known[0] is not message:
            known = self._frames[type(message)] = message, encode_server(message)
        return known[1]

    def _too_long(self, frame: Message) -> FrameError:
        return FrameError(
            "frame", f"at most {self.settings.max_message_size} bytes (max_message_size)", str(len(frame))
        )

    def _decode(self, client: int, frame: Message) -> ClientMessage:
        """Decode a frame. Raises FrameError, also for one that is too long; a service call gets its failure as well."""
        if len(frame) <= self.settings.max_message_size:
            return decode_client(frame)
        error = self._too_long(frame)
        if isinstance(frame, bytes):  # decoding copies no more than the payload
            request = decode_client(frame)
            if isinstance(request, ServiceRequest):
                self._answer(client, ServiceCallFailure(request.service_id, request.call_id, str(error)))
        raise error

    def _answer(self, client: int, message: ServerMessage) -> None:
        self._queues[client].put_control(encode_server(message))

    def _post_events(self, events: Iterable[Event]) -> None:
        for event in events:
            self.sink.post(event)
