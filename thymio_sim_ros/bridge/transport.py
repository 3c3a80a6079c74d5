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

from thymio_sim_ros.bridge.protocol.constants import Role

__all__ = ["SLICE_S", "SharedConnection", "SharedTransport"]

SLICE_S = 0.002
"""Time that one client may take of the event loop before others have their turn."""

_PIECE = 1 << 13
"""Bytes handed to the protocol at once: some thousand frames at most."""


class SharedTransport(asyncio.Transport):
    """A transport of the event loop; `try_write`, `write`, `abort` and `get_write_buffer_size` are open to all threads.

    Invariant: bytes are sent in the order of the calls. Bytes that the kernel does not accept wait here until the next
    write, or until the loop finds room. With TLS, waiting bytes go to the loop's transport.
    """

    def __init__(self, inner: asyncio.Transport, loop: asyncio.AbstractEventLoop) -> None:
        super().__init__()
        self._inner = inner
        self._loop = loop
        self._lock = threading.Lock()
        self._waiting = bytearray()
        self._is_ended = False
        self._is_flush_scheduled = False
        """Whether the loop sees to what waits."""
        # With TLS only the loop's transport can make the bytes; else a descriptor of our own, valid until `release`.
        is_plain = inner.get_extra_info("sslcontext") is None
        self._socket: socket.socket | None = inner.get_extra_info("socket").dup() if is_plain else None
        self._is_plain = is_plain
        self.is_paused = False
        """Whether its protocol wants to read nothing."""
        self._is_suspended = False
        self.on_resume: Callable[[], None] = lambda: None
        """Called in the loop's thread when the protocol wants to read again."""

    def write(self, data: bytes | bytearray | memoryview) -> None:
        """Send; what cannot be sent at once waits. Does nothing when the connection is ending."""
        self.try_write(bytes(data), sys.maxsize)

    def try_write(self, data: bytes, limit: int) -> bool:
        """The same unless more than `limit` bytes wait already; returns whether they did not."""
        with self._lock:
            if self._is_ended:
                return True
            if self._is_plain and (not self._waiting or self._flush_waiting()):
                sent = self._send(data)
                if sent == len(data):
                    return True
                data = data[sent:]
            elif self.get_write_buffer_size() > limit:
                return False
            self._waiting += data
            if not self._is_flush_scheduled:
                self._is_flush_scheduled = True
                self._loop.call_soon_threadsafe(self._schedule_flush)
            return True

    def get_write_buffer_size(self) -> int:
        """Bytes that the kernel has not taken yet."""
        return len(self._waiting) + self._inner.get_write_buffer_size()

    def abort(self) -> None:
        """End the connection at once, without what waits."""
        with self._lock:
            self._end()
        self._loop.call_soon_threadsafe(self._inner.abort)

    def release(self) -> None:
        """Give the descriptor back, or the client would not hear that the connection is gone. In the loop's thread."""
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
        """Give the kernel as much as it takes, and say how much that was."""
        assert self._socket is not None
        try:
            return self._socket.send(data)
        except (BlockingIOError, InterruptedError):
            return 0
        except OSError:
            return len(data)  # the connection is lost: the loop finds out by reading and ends it

    def _flush_waiting(self) -> bool:
        """Try to send what waits; whether nothing does any more."""
        del self._waiting[: self._send(self._waiting)]
        return not self._waiting

    def _schedule_flush(self) -> None:
        """Let the loop send what waits."""
        with self._lock:
            if self._socket is not None:
                self._loop.add_writer(self._socket, self._flush_when_writable)
            else:
                self._is_flush_scheduled = False
                self._move_to_inner()

    def _flush_when_writable(self) -> None:
        """There is room."""
        with self._lock:
            if self._socket is not None and self._flush_waiting():
                self._is_flush_scheduled = False
                self._loop.remove_writer(self._socket)

    def _move_to_inner(self) -> None:
        """Leave what waits to the loop's transport."""
        if self._waiting and not self._inner.is_closing():
            self._inner.write(bytes(self._waiting))
        self._waiting.clear()

    # --- what only the event loop's thread calls ---

    def writelines(self, list_of_data: Iterable[bytes | bytearray | memoryview]) -> None:
        """Send all."""
        self.write(b"".join(list_of_data))

    def can_write_eof(self) -> bool:
        """Whether `write_eof` is possible."""
        return self._inner.can_write_eof()

    def write_eof(self) -> None:
        """Say that nothing follows what was written."""
        self._end_after_flush()
        self._inner.write_eof()

    def close(self) -> None:
        """End the connection after what was written."""
        self._end_after_flush()
        self._inner.close()

    def _end_after_flush(self) -> None:
        with self._lock:
            self._move_to_inner()
            self._end()

    def is_closing(self) -> bool:
        """Whether the connection is ending."""
        return self._inner.is_closing()

    def get_extra_info(self, name: str, default: Any = None) -> Any:
        """Facts about the connection."""
        return self._inner.get_extra_info(name, default)

    def pause_reading(self) -> None:
        """Read nothing until `resume_reading`."""
        self.is_paused = True
        self._inner.pause_reading()

    def resume_reading(self) -> None:
        """Read again."""
        self.is_paused = False
        if not self._is_suspended:
            self._inner.resume_reading()
        self.on_resume()

    def suspend_reading(self, is_suspended: bool) -> None:
        """The same for a second party: data is received while neither of them minds."""
        self._is_suspended = is_suspended
        if is_suspended:
            self._inner.pause_reading()
        elif not self.is_paused:
            self._inner.resume_reading()

    def is_reading(self) -> bool:
        """Whether data is received."""
        return self._inner.is_reading()

    def set_write_buffer_limits(self, high: int | None = None, low: int | None = None) -> None:
        """When the protocol is told to pause writing."""
        self._inner.set_write_buffer_limits(high, low)

    def set_protocol(self, protocol: asyncio.BaseProtocol) -> None:
        """Who is told what arrives."""
        self._inner.set_protocol(protocol)

    def get_protocol(self) -> asyncio.BaseProtocol:
        """Who is told what arrives."""
        return self._inner.get_protocol()


class SharedConnection(ServerConnection):
    """A connection of `websockets` on a transport that others may write to as well.

    What arrives is handed to the protocol in small pieces, for `SLICE_S` at a time: a quarter of a megabyte may be
    forty thousand pings, which take the loop half a second.
    """

    transport: SharedTransport
    is_refused = False
    """Whether it is closed at once, unheard."""
    on_lost: Callable[[], None] = staticmethod(lambda: None)
    """Called when the connection is gone."""
    role: Role | None = None
    """What its client may do; None: it has to go."""

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """The client is there."""
        self._unread = bytearray()
        self._feeding: asyncio.TimerHandle | None = None
        if self.is_refused:
            cast(asyncio.Transport, transport).abort()
            return
        super().connection_made(SharedTransport(cast(asyncio.Transport, transport), asyncio.get_running_loop()))
        self.transport.on_resume = self._feed_later

    def connection_lost(self, exc: Exception | None) -> None:
        """The client is gone."""
        self._unread.clear()
        self._cancel_feeding()
        self.on_lost()
        if self.is_refused:
            return
        super().connection_lost(exc)
        self.transport.release()

    def data_received(self, data: bytes) -> None:
        """Bytes of the client."""
        if self.is_refused:
            return
        self._unread += data
        if self._feeding is None:
            self._feed()

    def eof_received(self) -> None:
        """The client sends nothing more."""
        if not self.is_refused:
            super().eof_received()

    def _feed(self) -> None:
        """Hand over what is unread, as long as the time lasts and the protocol takes it."""
        self._cancel_feeding()
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
