"""The way out to one client: never waits, keeps order, and bounds what a slow reader can cost.

Control frames always go to the socket's write buffer. Data frames do while the buffer is below its limit; beyond it
only the newest frame of each subscription is kept and sent when the buffer has drained. A reader that lets even
control frames pile up to `_CONTROL_FACTOR` limits is disconnected.
"""

from __future__ import annotations

from websockets.asyncio.server import ServerConnection, broadcast

from thymio_sim_ros.bridge.messages import Status
from thymio_sim_ros.bridge.vocabulary import StatusLevel
from thymio_sim_ros.bridge.wire import encode_server

_CONTROL_FACTOR = 8
_WARNING_PERIOD_S = 30.0
_WARNING = encode_server(
    # The first words are the vendor's: its clients show a tip when they read them.
    Status(StatusLevel.WARNING, "Send buffer limit reached: this connection is slow, only newest messages are sent")
)


class Outlet:
    """Frames for one connection."""

    def __init__(self, connection: ServerConnection, limit: int) -> None:
        self._connection = connection
        self._limit = limit
        self._newest: dict[int, bytes] = {}
        self._next_warning_s = float("-inf")
        self.dropped = 0
        """Data frames replaced by newer ones."""

    @property
    def is_behind(self) -> bool:
        """Whether data waits for the socket."""
        return bool(self._newest)

    def control(self, frame: str | bytes) -> None:
        """Send a frame that must not be lost."""
        broadcast((self._connection,), frame)
        if self._buffered() > _CONTROL_FACTOR * self._limit:
            self._connection.transport.abort()

    def data(self, subscription_id: int, frame: bytes, now_s: float) -> None:
        """Send a frame, or keep it as the newest of its subscription."""
        if not self._newest and self._buffered() <= self._limit:
            broadcast((self._connection,), frame)
            return
        self.dropped += subscription_id in self._newest
        self._newest[subscription_id] = frame
        if now_s >= self._next_warning_s:
            self._next_warning_s = now_s + _WARNING_PERIOD_S
            self.control(_WARNING)

    def flush(self) -> None:
        """Send kept frames as far as there is room now."""
        while self._newest and self._buffered() <= self._limit:
            subscription_id = next(iter(self._newest))
            broadcast((self._connection,), self._newest.pop(subscription_id))

    def forget(self, subscription_id: int) -> None:
        """Drop what is kept for an ended subscription."""
        self._newest.pop(subscription_id, None)

    def abort(self) -> None:
        """End the connection without waiting for the client."""
        self._connection.transport.abort()

    def _buffered(self) -> int:
        return self._connection.transport.get_write_buffer_size()
