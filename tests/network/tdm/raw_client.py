"""A blocking client of the device manager's TCP port."""

from __future__ import annotations

import socket
from collections.abc import Callable
from typing import TypeVar

from tests.patience import PATIENCE_S, Deadline
from thymio_sim_ros.network.tdm.protocol import messages as m
from thymio_sim_ros.network.tdm.protocol.codec import StreamReader, decode, encode, framed

T = TypeVar("T", bound=m.Message)


class RawClient:
    """Sends messages and waits for those that are expected."""

    def __init__(self, port: int, *, greet: bool = True) -> None:
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=PATIENCE_S)
        self._stream = StreamReader()
        self.received: list[m.Message] = []
        if greet:
            self.send(m.ConnectionHandshake())
            self.wait_for(m.NodesChanged)

    def __enter__(self) -> RawClient:
        return self

    def __exit__(self, *error: object) -> None:
        self.socket.close()

    def send(self, message: m.Message) -> None:
        """Send a message."""
        self.socket.sendall(framed(encode(message)))

    def read(self) -> bool:
        """Wait for data; False at the end of the connection."""
        try:
            data = self.socket.recv(1 << 16)
        except ConnectionError:
            return False
        self.received += [decode(buffer) for buffer in self._stream.feed(data)]
        return bool(data)

    def wait_for(self, kind: type[T], accept: Callable[[T], bool] = lambda message: True) -> T:
        """Wait for a message, and forget those before it."""
        deadline = Deadline()
        while not deadline.is_over:
            for index, message in enumerate(self.received):
                if isinstance(message, kind) and accept(message):
                    del self.received[: index + 1]
                    return message
            assert self.read(), f"connection closed before {kind.__name__}"
        raise AssertionError(f"no {kind.__name__}; received {self.received}")

    def wait_for_end(self) -> None:
        """Wait until the server closes the connection."""
        deadline = Deadline()
        while self.read():
            assert not deadline.is_over
