"""Connections to which any thread may write.

A message that crosses to the event loop's thread wakes it, and each of the two threads waits for the interpreter the
other one holds: that costs more than sending (docs/decisions.md). So whoever has a message gives it to the kernel at
once; only what the kernel does not take is left to the loop.
"""

from __future__ import annotations

import asyncio
import socket
import sys
import threading
from collections.abc import Iterable
from typing import Any, cast

from websockets.asyncio.server import ServerConnection

__all__ = ["SharedConnection", "SharedTransport"]


class SharedTransport(asyncio.Transport):
    """A transport of the event loop; `offer`, `write`, `abort` and `get_write_buffer_size` are open to all threads.

    Invariant: bytes leave in the order of the calls. They wait here, then in the loop's transport; nobody
    gives the kernel anything while something waits.
    """

    def __init__(self, inner: asyncio.Transport, loop: asyncio.AbstractEventLoop) -> None:
        super().__init__()
        self._inner = inner
        self._loop = loop
        self._lock = threading.Lock()
        self._waiting: list[bytes] = []
        self._waiting_size = 0
        self._is_ended = False
        # With TLS only the loop's transport can make the bytes; else a descriptor of our own, valid until `release`.
        is_plain = inner.get_extra_info("sslcontext") is None
        self._socket: socket.socket | None = inner.get_extra_info("socket").dup() if is_plain else None

    def write(self, data: bytes | bytearray | memoryview) -> None:
        """Send; what cannot be sent at once waits. Does nothing when the connection is ending."""
        self.offer(bytes(data), sys.maxsize)

    def offer(self, data: bytes, limit: int) -> bool:
        """The same unless more than `limit` bytes wait already; returns whether they did not."""
        with self._lock:
            before = self._waiting_size + self._inner.get_write_buffer_size()
            if before > limit:
                return False
            if self._is_ended or self._inner.is_closing():
                return True
            rest = data if before or self._socket is None else _send(self._socket, data)
            if rest:
                if not self._waiting:
                    self._loop.call_soon_threadsafe(self._hand_over)
                self._waiting.append(rest)
                self._waiting_size += len(rest)
            return True

    def get_write_buffer_size(self) -> int:
        """Bytes that the kernel has not taken yet."""
        return self._waiting_size + self._inner.get_write_buffer_size()

    def abort(self) -> None:
        """End the connection at once, without what waits."""
        self._end()
        self._loop.call_soon_threadsafe(self._inner.abort)

    def release(self) -> None:
        """Give the descriptor back: the connection is gone, or the client would not hear of it."""
        self._end()
        with self._lock:
            if self._socket is not None:
                self._socket.close()
                self._socket = None

    def _end(self) -> None:
        with self._lock:
            self._is_ended = True
            self._waiting.clear()
            self._waiting_size = 0

    def _hand_over(self) -> None:
        """Leave what waits to the loop's transport."""
        with self._lock:
            rest = b"".join(self._waiting)
            self._waiting.clear()
            self._waiting_size = 0
            if rest and not self._inner.is_closing():
                self._inner.write(rest)

    # --- what only the event loop's thread calls ---

    def writelines(self, list_of_data: Iterable[bytes | bytearray | memoryview]) -> None:
        """Send all."""
        self.write(b"".join(list_of_data))

    def can_write_eof(self) -> bool:
        """Whether `write_eof` is possible."""
        return self._inner.can_write_eof()

    def write_eof(self) -> None:
        """Say that nothing follows what was written."""
        self._finish()
        self._inner.write_eof()

    def close(self) -> None:
        """End the connection after what was written."""
        self._finish()
        self._inner.close()

    def _finish(self) -> None:
        self._hand_over()
        self._end()

    def is_closing(self) -> bool:
        """Whether the connection is ending."""
        return self._inner.is_closing()

    def get_extra_info(self, name: str, default: Any = None) -> Any:
        """Facts about the connection."""
        return self._inner.get_extra_info(name, default)

    def pause_reading(self) -> None:
        """Read nothing until `resume_reading`."""
        self._inner.pause_reading()

    def resume_reading(self) -> None:
        """Read again."""
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
    """A connection of `websockets` on a transport that others may write to as well."""

    transport: SharedTransport

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """The client is there."""
        super().connection_made(SharedTransport(cast(asyncio.Transport, transport), asyncio.get_running_loop()))

    def connection_lost(self, exc: Exception | None) -> None:
        """The client is gone."""
        super().connection_lost(exc)
        self.transport.release()


def _send(connection: socket.socket, data: bytes) -> bytes:
    """Give the kernel as much as it takes; returns the rest."""
    try:
        return data[connection.send(data) :]
    except (BlockingIOError, InterruptedError):
        return data
    except OSError:
        return b""  # the connection is lost: the loop finds out by reading and ends it
