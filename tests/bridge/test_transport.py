"""Several threads write to one connection."""

from __future__ import annotations

import asyncio
import socket
import struct
import threading
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager

import pytest

from tests.bridge.peers import run
from tests.patience import PATIENCE_S
from tests.systems import posix
from thymio_sim_ros.bridge.transport import SharedTransport

CHUNK = struct.Struct("<II992x")
"""The number of the writing thread, a counter, and padding."""


class Ends:
    """A shared transport and the plain socket at the other end."""

    def __init__(self, transport: SharedTransport, peer: socket.socket) -> None:
        self.transport = transport
        self.peer = peer

    def fill(self) -> int:
        """Write until bytes are buffered; return the number of written bytes."""
        written = 0
        while not self.transport.get_write_buffer_size():
            self.transport.write(bytes(1000))
            written += 1000
        return written

    async def read(self, size: int) -> bytes:
        """Read this number of bytes, or fewer at the end."""
        data = bytearray()
        async with asyncio.timeout(PATIENCE_S):
            while len(data) < size:
                piece = await asyncio.get_running_loop().sock_recv(self.peer, 1 << 16)
                if not piece:
                    break
                data += piece
        return bytes(data)


class Protocol(asyncio.Protocol):
    """Releases the transport as a connection does."""

    def __init__(self) -> None:
        self.transport: SharedTransport | None = None
        self.lost = asyncio.Event()

    def connection_lost(self, exc: Exception | None) -> None:
        assert self.transport is not None
        self.transport.release()
        self.lost.set()


@asynccontextmanager
async def ends() -> AsyncIterator[Ends]:
    """Two ends of a connection whose kernel buffers are small."""
    loop = asyncio.get_running_loop()
    near, far = socket.socketpair()
    for end in (near, far):
        end.setblocking(False)
        end.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 4096)
    inner, protocol = await loop.connect_accepted_socket(Protocol, near)
    protocol.transport = SharedTransport(inner, loop)
    try:
        yield Ends(protocol.transport, far)
    finally:
        protocol.transport.abort()
        await protocol.lost.wait()
        far.close()


def test_messages_of_two_threads_arrive_whole_and_in_order() -> None:
    count = 2000

    async def scenario() -> None:
        async with ends() as pair:

            def write(writer: int) -> None:
                for number in range(count):
                    pair.transport.write(CHUNK.pack(writer, number))

            other = threading.Thread(target=write, args=(1,))
            other.start()
            reading = asyncio.create_task(pair.read(2 * count * CHUNK.size))
            for number in range(count):
                pair.transport.write(CHUNK.pack(0, number))
                if number % 10 == 0:
                    await asyncio.sleep(0)
            data = await reading
            other.join()
            chunks = list(CHUNK.iter_unpack(data))
            for writer in (0, 1):
                assert [number for thread, number in chunks if thread == writer] == list(range(count))

    run(scenario())


@posix
def test_bytes_that_the_kernel_does_not_accept_are_buffered_and_counted() -> None:
    async def scenario() -> None:
        async with ends() as pair:
            written = pair.fill()
            waiting = pair.transport.get_write_buffer_size()
            assert 0 < waiting <= 1000
            pair.transport.write(bytes(5000))
            assert pair.transport.get_write_buffer_size() == waiting + 5000
            assert len(await pair.read(written + 5000)) == written + 5000
            assert pair.transport.get_write_buffer_size() == 0

    run(scenario())


@posix
def test_try_write_fails_while_more_than_the_limit_is_buffered() -> None:
    async def scenario() -> None:
        async with ends() as pair:
            written = pair.fill()
            waiting = pair.transport.get_write_buffer_size()
            assert not pair.transport.try_write(b"late", waiting - 1)
            assert pair.transport.try_write(b"in time", waiting)
            assert (await pair.read(written + 7)).endswith(b"in time")

    run(scenario())


@pytest.mark.parametrize("end", [SharedTransport.close, SharedTransport.write_eof])
def test_all_that_was_written_arrives_before_the_end(end: Callable[[SharedTransport], None]) -> None:
    async def scenario() -> None:
        async with ends() as pair:
            written = pair.fill()
            pair.transport.write(b"the last")
            end(pair.transport)
            pair.transport.write(b"too late")
            data = await pair.read(written + 100)
            assert len(data) == written + 8
            assert data.endswith(b"the last")

    run(scenario())


def test_another_thread_may_abort_a_connection() -> None:
    async def scenario() -> None:
        async with ends() as pair:
            written = pair.fill()
            await asyncio.to_thread(pair.transport.abort)
            assert len(await pair.read(written)) < written

    run(scenario())


def test_writing_to_a_disconnected_client_has_no_effect() -> None:
    async def scenario() -> None:
        async with ends() as pair:
            pair.peer.close()
            pair.transport.write(b"lost")
            pair.transport.write(b"lost")
            assert pair.transport.get_write_buffer_size() == 0
            pair.transport.release()
            pair.transport.write(b"lost")
            assert pair.transport.get_write_buffer_size() == 0

    run(scenario())
