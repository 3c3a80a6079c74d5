"""Connections to which any thread may write.

Passing a message to the thread of the event loop costs more than sending it, because both threads wait for the
interpreter lock (docs/decisions.md). The calling thread therefore writes to the socket itself; only bytes that the
kernel does not accept are left to the loop.
"""

from __future__ import annotations

import asyncio
import socket
import sys
import threading
import time
from collections.abc import Callable, Iterable
from typing import Any, cast

from websockets.asyncio.server import ServerConnection
from websockets.protocol import State

from thymio_sim_ros.bridge.connections import Connections, ConnectionSlot, Phase
from thymio_sim_ros.bridge.protocol.constants import Role

__all__ = ["SLICE_S", "ConnectionMaker", "SharedConnection", "SharedTransport"]

SLICE_S = 0.002
"""Processor time of the event loop that one client may use before other clients are served, s."""

_PIECE = 1 << 13
"""Bytes passed to the protocol in one call: at most some thousand frames."""


class SharedTransport(asyncio.Transport):
    """A transport of the event loop; `try_write`, `write`, `abort` and `get_write_buffer_size` are open to all threads.

    Invariant: bytes are sent in the order of the calls. Bytes that the kernel does not accept are buffered here until
    the next write, or until the loop reports the socket as writable. With TLS, only the loop's transport can encrypt:
    all bytes are passed on to it in the thread of the loop.
    """

    def __init__(self, inner: asyncio.Transport, loop: asyncio.AbstractEventLoop) -> None:
        super().__init__()
        self._inner = inner
        self._loop = loop
        self._lock = threading.Lock()
        self._waiting = bytearray()
        self._is_ended = False
        self._is_flush_scheduled = False
        """Whether the loop is going to send the buffered bytes."""
        # A duplicate of the descriptor stays valid until `release`: the loop's transport may close its own one while
        # another thread is sending, and the number could then belong to another connection. None with TLS.
        is_plain = inner.get_extra_info("sslcontext") is None
        self._socket: socket.socket | None = inner.get_extra_info("socket").dup() if is_plain else None
        self._is_plain = is_plain
        self.is_paused = False
        """Whether the protocol has paused reading."""
        self._is_suspended = False
        self.on_resume: Callable[[], None] = lambda: None
        """Called in the loop's thread when the protocol resumes reading."""

    def write(self, data: bytes | bytearray | memoryview) -> None:
        """Send bytes, buffered without limit. Does nothing if the connection is closing."""
        self.try_write(bytes(data), sys.maxsize)

    def try_write(self, data: bytes, limit: int) -> bool:
        """Send bytes unless more than `limit` bytes are buffered; return False if they were not sent.

        Returns True without sending if the connection is closing.
        """
        with self._lock:
            if self._is_ended:
                return True
            # Only with an empty buffer may these bytes go to the kernel directly: they would overtake buffered ones.
            if self._is_plain and (not self._waiting or self._flush_waiting()):
                sent = self._send(data)
                if sent == len(data):
                    return True
                # From here on `limit` no longer applies: without the rest, the stream would contain a part of a frame.
                data = data[sent:]
            elif self.get_write_buffer_size() > limit:
                return False
            self._waiting += data
            # The loop is woken once when bytes wait, not for each write. It registers the socket itself, because
            # `add_writer` may be called in its thread only.
            if not self._is_flush_scheduled:
                self._is_flush_scheduled = True
                self._loop.call_soon_threadsafe(self._schedule_flush)
            return True

    def get_write_buffer_size(self) -> int:
        """Bytes that the kernel has not accepted yet."""
        return len(self._waiting) + self._inner.get_write_buffer_size()

    def abort(self) -> None:
        """Close the connection immediately and drop the buffered bytes."""
        with self._lock:
            self._end()
        self._loop.call_soon_threadsafe(self._inner.abort)

    def release(self) -> None:
        """Close the duplicated descriptor, without which the client would not see the end of the connection.

        Only the loop's thread may call it.
        """
        with self._lock:
            self._end()
            if self._socket is not None:
                self._loop.remove_writer(self._socket)
                self._socket.close()
                self._socket = None

    def _end(self) -> None:
        self._is_ended = True
        self._waiting.clear()

    def _send(self, data: bytes | bytearray) -> int:
        """Pass bytes to the kernel without blocking; return the number of accepted bytes."""
        assert self._socket is not None
        try:
            return self._socket.send(data)
        except (BlockingIOError, InterruptedError):
            return 0
        except OSError:
            return len(data)  # the connection is lost: the loop detects it by reading, and closes it

    def _flush_waiting(self) -> bool:
        """Try to send the buffered bytes; return whether the buffer is empty."""
        del self._waiting[: self._send(self._waiting)]
        return not self._waiting

    def _schedule_flush(self) -> None:
        """Make the loop send the buffered bytes as soon as the socket is writable."""
        with self._lock:
            # `release` may have run since another thread scheduled this call; `_waiting` is empty then.
            if self._socket is not None:
                self._loop.add_writer(self._socket, self._flush_when_writable)
            else:
                self._is_flush_scheduled = False
                self._move_to_inner()

    def _flush_when_writable(self) -> None:
        """Send buffered bytes; called by the loop when the socket is writable."""
        # The loop calls this in every iteration while the socket is writable, so the writer is removed with the last
        # byte. Both happen under the lock: a write of another thread either comes before and is sent here, or comes
        # after and schedules the next flush.
        with self._lock:
            if self._socket is not None and self._flush_waiting():
                self._is_flush_scheduled = False
                self._loop.remove_writer(self._socket)

    def _move_to_inner(self) -> None:
        """Pass the buffered bytes to the loop's transport."""
        if self._waiting and not self._inner.is_closing():
            self._inner.write(bytes(self._waiting))
        self._waiting.clear()

    # --- called by the event loop's thread only ---

    def writelines(self, list_of_data: Iterable[bytes | bytearray | memoryview]) -> None:
        """Send several pieces as one."""
        self.write(b"".join(list_of_data))

    def can_write_eof(self) -> bool:
        """Whether `write_eof` is possible."""
        return self._inner.can_write_eof()

    def write_eof(self) -> None:
        """Close the writing direction after the buffered bytes."""
        self._end_after_flush()
        self._inner.write_eof()

    def close(self) -> None:
        """Close the connection after the buffered bytes."""
        self._end_after_flush()
        self._inner.close()

    def _end_after_flush(self) -> None:
        with self._lock:
            self._move_to_inner()
            self._end()

    def is_closing(self) -> bool:
        """Whether the connection is closing."""
        return self._inner.is_closing()

    def get_extra_info(self, name: str, default: Any = None) -> Any:
        """Information on the connection, such as `peername`."""
        return self._inner.get_extra_info(name, default)

    def pause_reading(self) -> None:
        """Stop reading until `resume_reading`."""
        self.is_paused = True
        self._inner.pause_reading()

    def resume_reading(self) -> None:
        """Resume reading, unless it is also suspended."""
        self.is_paused = False
        if not self._is_suspended:
            self._inner.resume_reading()
        self.on_resume()

    def suspend_reading(self, is_suspended: bool) -> None:
        """Stop or resume reading, independently of `pause_reading`: data is received while neither applies."""
        self._is_suspended = is_suspended
        if is_suspended:
            self._inner.pause_reading()
        elif not self.is_paused:
            self._inner.resume_reading()

    def is_reading(self) -> bool:
        """Whether data is received."""
        return self._inner.is_reading()

    def set_write_buffer_limits(self, high: int | None = None, low: int | None = None) -> None:
        """Set the buffer sizes at which the protocol is asked to pause and to resume writing."""
        self._inner.set_write_buffer_limits(high, low)

    def set_protocol(self, protocol: asyncio.BaseProtocol) -> None:
        """Set the protocol that receives the data."""
        self._inner.set_protocol(protocol)

    def get_protocol(self) -> asyncio.BaseProtocol:
        """The protocol that receives the data."""
        return self._inner.get_protocol()


class SharedConnection(ServerConnection):
    """A connection of `websockets` whose transport is shared with other threads.

    Received data is passed to the protocol in small pieces, for `SLICE_S` at a time: a quarter of a megabyte may
    contain forty thousand pings, which would block the loop for half a second.
    """

    transport: SharedTransport
    maker: ConnectionMaker
    """The connections of its server."""
    slot: ConnectionSlot | None = None
    """None: the connection is closed immediately, without reading, because there are too many."""
    role: Role | None = None
    """Role of its client; None: the client gave no valid token, and the connection has to be closed."""

    @property
    def is_rosbridge(self) -> bool:
        """Whether its client uses the rosbridge protocol, which has no sub-protocol name."""
        return self.subprotocol is None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Wrap the transport of a new connection."""
        self._unread = bytearray()
        self._feeding: asyncio.TimerHandle | None = None
        plain = cast(asyncio.Transport, transport)
        self.slot = self.maker.admit(plain)
        if self.slot is None:
            plain.abort()
            return
        super().connection_made(SharedTransport(plain, asyncio.get_running_loop()))
        self.transport.on_resume = self._feed_later

    def connection_lost(self, exc: Exception | None) -> None:
        """Release the transport."""
        self._unread.clear()
        self._cancel_feeding()
        if self.slot is None:
            return
        self.maker.connections.remove(self.slot)
        super().connection_lost(exc)
        self.transport.release()

    def data_received(self, data: bytes) -> None:
        """Receive bytes of the client."""
        if self.slot is None:
            return
        if self.slot.phase is Phase.SILENT:
            self.maker.connections.set_phase(self.slot, Phase.READING)
        self._unread += data
        if self._feeding is None:
            self._feed()

    def eof_received(self) -> None:
        """Note that the client sends no more bytes."""
        if self.slot is not None:
            super().eof_received()

    async def handshake(self, *arguments: Any, **options: Any) -> None:
        """Perform the opening handshake; from its success on, the connection is not evicted for another one."""
        await super().handshake(*arguments, **options)
        if self.slot is not None and self.state is State.OPEN:
            self.maker.connections.set_phase(self.slot, Phase.STREAMING)

    def _feed(self) -> None:
        """Pass unread bytes to the protocol until `SLICE_S` is spent or the protocol pauses reading.

        After a full slice the next one starts only when the same time has passed again: a client that floods the
        connection uses at most half of the loop's time, and the kernel's buffer slows it down.
        """
        self._cancel_feeding()
        # Time of this thread, not of the wall: other threads that hold the interpreter lock do not shorten the slice.
        began_s, spent_s = time.thread_time(), 0.0
        while self._unread and not self.transport.is_paused and spent_s < SLICE_S:
            piece = bytes(self._unread[:_PIECE])
            del self._unread[:_PIECE]
            super().data_received(piece)
            spent_s = time.thread_time() - began_s
        self.transport.suspend_reading(bool(self._unread))
        if self._unread and not self.transport.is_paused:
            self._feed_later(spent_s)

    def _feed_later(self, pause_s: float = 0.0) -> None:
        if self._unread and self._feeding is None:
            self._feeding = asyncio.get_running_loop().call_later(pause_s, self._feed)

    def _cancel_feeding(self) -> None:
        if self._feeding is not None:
            self._feeding.cancel()
            self._feeding = None


class ConnectionMaker:
    """Makes the connections of one server, up to a limit.

    At the limit, a new connection gets the slot of one whose handshake is not complete (`connections`), and is refused
    if there is none.
    """

    def __init__(self, limit: int, on_refused: Callable[[], None]) -> None:
        """`limit`: connections, including those in their handshake; `on_refused` is called for each further one."""
        self.connections = Connections(limit, time.monotonic)
        """The open connections."""
        self._on_refused = on_refused

    def __call__(self, *arguments: Any, **options: Any) -> SharedConnection:
        """Make a connection, as `websockets` calls its class."""
        connection = SharedConnection(*arguments, **options)
        connection.maker = self
        return connection

    def admit(self, transport: asyncio.Transport) -> ConnectionSlot | None:
        """The slot of a new connection, or None if it is refused."""
        if not self.connections.make_room():
            self._on_refused()
            return None
        peer = transport.get_extra_info("peername")
        slot = self.connections.add(str(peer[0]) if peer else "")
        slot.close = transport.abort
        return slot
