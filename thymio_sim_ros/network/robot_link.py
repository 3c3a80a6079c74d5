"""The connection to a robot, by TCP or a serial port, in a thread with an event loop; it connects again by itself."""

from __future__ import annotations

import asyncio
import contextlib
import os
import socket
import threading
from collections.abc import Callable
from dataclasses import dataclass

from aseba_vm.protocol import FrameReader, Message, ProtocolError, decode
from thymio_sim_ros.bridge.listening import detect_lost_peer
from thymio_sim_ros.network.robot_target import SerialTarget, Target, TcpTarget
from thymio_sim_ros.network.serial_stream import SerialStream

__all__ = ["LinkEvent", "LinkLost", "LinkOpened", "LinkReceived", "RobotLink"]

FIRST_PAUSE_S, LONGEST_PAUSE_S = 0.25, 4.0
"""Pauses between attempts to connect; each is twice as long as the one before."""
CONNECT_S = 5.0
CLOSE_S = 1.0
SILENCE_S = 10.0
"""Time without data after which the connection is given up: robots are asked every second whether they are there."""
MAX_PAYLOAD = 4096
"""Longest accepted payload in bytes; robots send at most 518."""
MAX_WAITING = 256 * 1024
"""Bytes that wait to be sent, after which the connection is given up."""
CHUNK = 65536
FULL_PAUSE_S = 0.01
BAUD_RATE = 115_200
THYMIO_VENDOR = 0x0617
"""USB vendor of Thymio and of its wireless dongle."""


@dataclass(frozen=True, slots=True)
class LinkOpened:
    """The stream is open."""


@dataclass(frozen=True, slots=True)
class LinkReceived:
    """Messages have arrived, in order."""

    messages: tuple[Message, ...]


@dataclass(frozen=True, slots=True)
class LinkLost:
    """The stream has ended, or could not be opened; the next attempt follows."""

    reason: str


LinkEvent = LinkOpened | LinkReceived | LinkLost


@dataclass(frozen=True, slots=True)
class _Stream:
    """Both directions of a connection, and the serial port at its end, if it is one."""

    reader: asyncio.StreamReader
    writer: asyncio.StreamWriter
    port: SerialStream | None = None

    async def close(self, *, flush: bool) -> None:
        """Close the connection, after what waits to be sent if `flush`."""
        with contextlib.suppress(OSError, TimeoutError):
            async with asyncio.timeout(CLOSE_S):
                if flush and not self.writer.transport.is_closing():
                    await self.writer.drain()
                self.writer.close()
                await self.writer.wait_closed()
        if self.port is not None:
            await asyncio.to_thread(self.port.join, CLOSE_S)


class RobotLink:
    """A stream to a robot that is opened again whenever it ends. Events arrive on the thread of the link."""

    def __init__(self, target: Target, on_event: Callable[[LinkEvent], None], is_full: Callable[[], bool]) -> None:
        """`on_event` must be thread-safe; while `is_full` returns true, nothing is read."""
        self._target, self._on_event, self._is_full = target, on_event, is_full
        self._loop = asyncio.SelectorEventLoop()  # as `ServerThread`
        self._stream: _Stream | None = None
        self._stop = asyncio.Event()
        self._is_closed = False
        self._is_confirmed = False
        self._thread = threading.Thread(target=self._run, name="robot-link", daemon=True)
        self._thread.start()

    def send(self, data: bytes) -> None:
        """Send bytes, which are dropped while there is no stream; from any thread."""
        if not self._is_closed:
            self._loop.call_soon_threadsafe(self._write, data)

    def confirm(self) -> None:
        """Note that a robot has described itself on this stream; from any thread.

        If the stream ends, the next attempt follows soon. A port that opens is no robot yet: one that sends other data
        is tried less and less often.
        """
        self._is_confirmed = True

    def close(self, last: bytes = b"") -> None:
        """Send `last`, then end stream and thread."""
        if self._is_closed:
            return
        self.send(last)
        self._is_closed = True
        self._loop.call_soon_threadsafe(self._stop.set)
        self._thread.join()

    def _run(self) -> None:
        try:
            self._loop.run_until_complete(self._stay_connected())
        finally:
            self._loop.run_until_complete(self._loop.shutdown_asyncgens())
            self._loop.close()

    async def _stay_connected(self) -> None:
        reading = asyncio.create_task(self._connect_for_ever())
        await self._stop.wait()
        reading.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await reading

    async def _connect_for_ever(self) -> None:
        pause_s = FIRST_PAUSE_S
        while True:
            self._is_confirmed = False
            try:
                async with asyncio.timeout(CONNECT_S):
                    self._stream = await _open(self._target)
            except (OSError, TimeoutError) as error:
                self._on_event(LinkLost(_reason(error, f"no answer within {CONNECT_S:g} s")))
            else:
                self._on_event(LinkOpened())
                self._on_event(LinkLost(await self._read(self._stream)))
            if self._is_confirmed:
                pause_s = FIRST_PAUSE_S
            await asyncio.sleep(pause_s)
            pause_s = min(2 * pause_s, LONGEST_PAUSE_S)

    async def _read(self, stream: _Stream) -> str:
        """Pass messages on until the stream ends; return the reason."""
        frames = FrameReader(MAX_PAYLOAD)
        try:
            while True:
                async with asyncio.timeout(SILENCE_S):
                    data = await stream.reader.read(CHUNK)
                if not data:
                    return "the connection was closed"
                messages = tuple(_decoded(frames.feed(data)))
                if messages:
                    self._on_event(LinkReceived(messages))
                while self._is_full():
                    await asyncio.sleep(FULL_PAUSE_S)
        except (OSError, TimeoutError, ProtocolError) as error:
            return _reason(error, f"no data for {SILENCE_S:g} s")
        finally:
            self._stream = None
            await stream.close(flush=self._is_closed)

    def _write(self, data: bytes) -> None:
        if self._stream is None or not data:
            return
        writer = self._stream.writer
        if writer.transport.get_write_buffer_size() > MAX_WAITING:
            writer.transport.abort()  # the reader then ends
            return
        writer.write(data)


def _decoded(frames: list[bytes]) -> list[Message]:
    """The messages of frames; frames that are no messages are skipped."""
    messages = []
    for frame in frames:
        with contextlib.suppress(ProtocolError):
            messages.append(decode(frame))
    return messages


def _reason(error: Exception, timeout: str) -> str:
    if isinstance(error, TimeoutError) and not error.args:
        return timeout
    if isinstance(error, OSError) and error.errno is not None and error.errno > 0:
        return os.strerror(error.errno).lower()  # the text of asyncio is about a call
    return str(error)


async def _open(target: Target) -> _Stream:
    if isinstance(target, TcpTarget):
        reader, writer = await asyncio.open_connection(target.host, target.port)
        connection = writer.get_extra_info("socket")
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        detect_lost_peer(connection)
        return _Stream(reader, writer)
    return await _open_serial(target)


async def _open_serial(target: SerialTarget) -> _Stream:
    """Open a serial port. Raises OSError."""
    port = SerialStream(target.device or _first_thymio(), BAUD_RATE)
    reader, writer = await asyncio.open_connection(sock=port.socket)
    return _Stream(reader, writer, port)


def _first_thymio() -> str:
    """Device of the first serial port of a Thymio. Raises OSError if there is none."""
    from serial.tools import list_ports

    ports = sorted(list_ports.comports(), key=lambda port: port.device)
    device: str | None = next((port.device for port in ports if port.vid == THYMIO_VENDOR), None)
    if device is None:
        found = ", ".join(port.device for port in ports) or "no serial ports"
        raise OSError(f"no Thymio found, but {found}; name the port, as in ser:/dev/ttyACM0")
    return device
