"""tdmclient, the Python client (PyPI), with a device manager at any address: by itself it knows host and port only."""

from __future__ import annotations

import ssl
from collections.abc import Awaitable, Callable
from typing import Any, TypeVar

import pytest

from tests.patience import PATIENCE_S

T = TypeVar("T")


class Transport:
    """A WebSocket, in the form of a `TDMConnection`. Certificates are not checked."""

    def __init__(self, address: str) -> None:
        websocket = pytest.importorskip("websocket", reason="needs websocket-client (pip install websocket-client)")
        self._timeout_error = websocket.WebSocketTimeoutException
        self._socket = websocket.create_connection(address, timeout=PATIENCE_S, sslopt={"cert_reqs": ssl.CERT_NONE})

    def close(self) -> None:
        """Close the connection."""
        self._socket.close()

    def request_shutdown(self, on_terminated: Callable[[], object] | None = None) -> None:
        """Close the connection."""
        self.close()
        if on_terminated is not None:
            on_terminated()

    def send_packet(self, packet: bytes) -> None:
        """Send a message."""
        self._socket.send_binary(packet)

    def receive_packet(self) -> bytes | None:
        """The next message, None if there is none."""
        self._socket.settimeout(0.001)
        try:
            received: bytes = self._socket.recv()
        except self._timeout_error:
            return None
        finally:
            self._socket.settimeout(PATIENCE_S)
        return received


def with_robot(address: str, password: str, use: Callable[[Any], Awaitable[T]]) -> T:
    """Lock the first robot of a device manager, and return what `use` makes with its node."""
    tdmclient = pytest.importorskip("tdmclient", reason="needs tdmclient (pip install tdmclient)")
    found: list[T] = []

    async def program() -> None:
        with await client.lock() as node:
            found.append(await use(node))

    with tdmclient.ClientAsync(tdm_transport=Transport(address), password=password) as client:
        client.run_async_program(program)
    return found[0]
