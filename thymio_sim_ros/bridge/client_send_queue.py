"""The way out to one client: never waits, keeps order, and bounds what a slow reader can cost.

Control frames always go to the socket's write buffer. Data frames do while the buffer is below its limit; beyond it
only the newest frame of each subscription is kept and sent when the buffer has drained. A reader that lets even
control frames pile up to `_CONTROL_FACTOR` limits is disconnected.
"""

from __future__ import annotations

import time
from collections.abc import Callable

from websockets.protocol import State

from thymio_sim_ros.bridge.constants import StatusLevel
from thymio_sim_ros.bridge.framing import data_frame, framed
from thymio_sim_ros.bridge.messages import Status
from thymio_sim_ros.bridge.transport import SharedConnection
from thymio_sim_ros.bridge.wire import encode_server

Way = Callable[[int, bytes], bool]
"""Sends data of a time, ns; returns whether it is done with."""

_CONTROL_FACTOR = 8
_WARNING_PERIOD_S = 30.0
_WARNING = framed(
    encode_server(
        # The first words are the vendor's: its clients show a tip when they read them.
        Status(StatusLevel.WARNING, "Send buffer limit reached: this connection is slow, only newest messages are sent")
    )
)


class Outlet:
    """Frames for one connection; called by one thread at a time, whichever it is."""

    def __init__(self, connection: SharedConnection, limit: int) -> None:
        self._protocol = connection.protocol
        self._transport = connection.transport
        self._limit = limit
        self._newest: dict[int, bytes] = {}
        self._next_warning_s = float("-inf")
        self.dropped = 0
        """Data frames replaced by newer ones."""

    @property
    def is_behind(self) -> bool:
        """Whether data waits for the socket."""
        return bool(self._newest)

    def control(self, frame: bytes) -> None:
        """Send a frame that must not be lost, however large it is; too much that waits already ends the connection."""
        if self._transport.get_write_buffer_size() > _CONTROL_FACTOR * self._limit:
            self._transport.abort()
        elif self._is_open():
            self._transport.write(frame)

    def way(self, subscription_id: int) -> Way:
        """As `data` for the messages of a subscription: hot path, so what it needs is bound here once."""
        protocol, offer, limit, newest = self._protocol, self._transport.offer, self._limit, self._newest
        later, keep, is_open = self.data, self._keep, State.OPEN

        def send(time_ns: int, payload: bytes) -> bool:
            frame = data_frame(subscription_id, time_ns, payload)
            if newest:
                return later(subscription_id, frame)
            if protocol.state is not is_open or offer(frame, limit):
                return True
            keep(subscription_id, frame)
            return False

        return send

    def data(self, subscription_id: int, frame: bytes) -> bool:
        """Send a frame, or keep it as the newest of its subscription; returns whether it is done with."""
        self.flush()
        if not self._newest and self._offer(frame):
            return True
        self._keep(subscription_id, frame)
        return False

    def _keep(self, subscription_id: int, frame: bytes) -> None:
        self.dropped += subscription_id in self._newest
        self._newest[subscription_id] = frame
        now_s = time.monotonic()
        if now_s >= self._next_warning_s:
            self._next_warning_s = now_s + _WARNING_PERIOD_S
            self.control(_WARNING)

    def flush(self) -> None:
        """Send kept frames as far as there is room now."""
        while self._newest:
            subscription_id = next(iter(self._newest))
            if not self._offer(self._newest[subscription_id]):
                return
            del self._newest[subscription_id]

    def forget(self, subscription_id: int) -> None:
        """Drop what is kept for an ended subscription."""
        self._newest.pop(subscription_id, None)

    def abort(self) -> None:
        """End the connection without waiting for the client."""
        self._transport.abort()

    def _offer(self, frame: bytes) -> bool:
        """Send unless too much waits; returns whether it is done with."""
        return not self._is_open() or self._transport.offer(frame, self._limit)

    def _is_open(self) -> bool:
        """Nothing may follow a frame that closes."""
        return self._protocol.state is State.OPEN
