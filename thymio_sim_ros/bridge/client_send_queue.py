"""The send queue of one client: never blocks, keeps the order, and limits the memory that a slow client can use.

Control frames are always written to the socket's buffer. Data frames are written while the buffer is below its limit;
beyond it only the newest frame of each subscription is kept and sent when the buffer has drained. A client is
disconnected if even control frames fill `_CONTROL_FACTOR` times the limit.
"""

from __future__ import annotations

import time
from collections.abc import Callable

from websockets.protocol import State

from thymio_sim_ros.bridge.framing import data_frame, framed
from thymio_sim_ros.bridge.protocol.constants import StatusLevel
from thymio_sim_ros.bridge.protocol.messages import Status
from thymio_sim_ros.bridge.protocol.wire import encode_server
from thymio_sim_ros.bridge.rosbridge import frames
from thymio_sim_ros.bridge.transport import SharedConnection

SendFunction = Callable[[int, bytes], bool]
"""Sends a payload with its time in ns; returns False if the frame was kept for later."""

_CONTROL_FACTOR = 8
_WARNING_PERIOD_S = 30.0
# The vendor's clients recognize the first words and show a hint.
_WARNING = "Send buffer limit reached: this connection is slow, only newest messages are sent"
_FOXGLOVE_WARNING = framed(encode_server(Status(StatusLevel.WARNING, _WARNING)))
_ROSBRIDGE_WARNING = framed(frames.as_json(frames.status("warning", _WARNING)))


class ClientSendQueue:
    """Frames for one connection. Any thread may call it, but only one at a time."""

    def __init__(self, connection: SharedConnection, limit: int) -> None:
        """`limit`: bytes in the socket's buffer above which data frames are kept."""
        self._warning = _ROSBRIDGE_WARNING if connection.is_rosbridge else _FOXGLOVE_WARNING
        self._protocol = connection.protocol
        self._transport = connection.transport
        self._limit = limit
        self._newest: dict[int, bytes] = {}
        self._next_warning_s = float("-inf")

    @property
    def has_backlog(self) -> bool:
        """Whether data frames are kept until the socket's buffer has room."""
        return bool(self._newest)

    def send_control(self, frame: bytes) -> None:
        """Send a frame that must not be lost, of any size; disconnect the client if too many bytes are buffered."""
        if self._transport.get_write_buffer_size() > _CONTROL_FACTOR * self._limit:
            self._transport.abort()
        elif self._is_open():
            self._transport.write(frame)

    def sender(self, subscription_id: int) -> SendFunction:
        """A function that sends messages of one subscription.

        This is the hot path: the function binds everything it needs once, because attribute look-ups and calls cost
        more than the rest.
        """
        protocol, try_write, limit, newest = self._protocol, self._transport.try_write, self._limit, self._newest
        later, keep, is_open = self.send_data, self._keep, State.OPEN

        def send(time_ns: int, payload: bytes) -> bool:
            frame = data_frame(subscription_id, time_ns, payload)
            if newest:
                return later(subscription_id, frame)
            if protocol.state is not is_open or try_write(frame, limit):
                return True
            keep(subscription_id, frame)
            return False

        return send

    def send_data(self, subscription_id: int, frame: bytes) -> bool:
        """Send a frame, or keep it as the newest of its subscription and return False."""
        self.flush()
        if not self._newest and self._try_write(frame):
            return True
        self._keep(subscription_id, frame)
        return False

    def _keep(self, subscription_id: int, frame: bytes) -> None:
        self._newest[subscription_id] = frame
        now_s = time.monotonic()
        if now_s >= self._next_warning_s:
            self._next_warning_s = now_s + _WARNING_PERIOD_S
            self.send_control(self._warning)

    def flush(self) -> None:
        """Send kept frames while there is room."""
        while self._newest:
            subscription_id = next(iter(self._newest))
            if not self._try_write(self._newest[subscription_id]):
                return
            del self._newest[subscription_id]

    def discard(self, subscription_id: int) -> None:
        """Drop the frame kept for an ended subscription."""
        self._newest.pop(subscription_id, None)

    def abort(self) -> None:
        """Close the connection without waiting for the client."""
        self._transport.abort()

    def _try_write(self, frame: bytes) -> bool:
        """Write a frame unless the buffer is over its limit; return False if it was not written."""
        return not self._is_open() or self._transport.try_write(frame, self._limit)

    def _is_open(self) -> bool:
        """Whether frames may be sent: none may follow a close frame."""
        return self._protocol.state is State.OPEN
