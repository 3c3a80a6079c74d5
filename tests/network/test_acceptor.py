"""Accepting connections: errors, and the end of a connection."""

from __future__ import annotations

import asyncio
import errno
import socket

import pytest

from tests.patience import PATIENCE_S
from thymio_sim_ros.network.acceptor import Acceptor

pytestmark = pytest.mark.process


class _Listener(socket.socket):
    """A listening socket that fails the first time, as without a free descriptor."""

    has_failed = False

    def accept(self) -> tuple[socket.socket, tuple[str, int]]:
        if not self.has_failed:
            self.has_failed = True
            raise OSError(errno.EMFILE, "Too many open files")
        return super().accept()


def test_an_error_is_reported_and_the_client_is_accepted_later() -> None:
    async def serve(accepted: socket.socket, address: str) -> None:
        await asyncio.get_running_loop().sock_sendall(accepted, address.encode())

    async def connect() -> bytes:
        acceptor = Acceptor([listener], serve, errors.append)
        reader, writer = await asyncio.open_connection(*listener.getsockname())
        answer = await asyncio.wait_for(reader.read(), PATIENCE_S)  # to the end: it is closed when it has been served
        writer.close()
        await writer.wait_closed()
        assert acceptor.count == 0
        acceptor.close()
        await acceptor.wait_closed()
        return answer

    errors: list[OSError] = []
    with _Listener() as listener:
        listener.bind(("127.0.0.1", 0))
        listener.listen()
        assert asyncio.run(connect()) == b"127.0.0.1"
    assert [error.errno for error in errors] == [errno.EMFILE]
