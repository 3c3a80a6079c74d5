"""A blocking client of an Aseba port. Every wait ends with a TimeoutError."""

from __future__ import annotations

import contextlib
import socket

from aseba_vm.protocol import FrameReader, Message, decode, encode
from tests.patience import PATIENCE_S, Deadline


class AsebaClient:
    """One connection to a port of this computer."""

    def __init__(self, port: int) -> None:
        self.port = port
        self.stream = socket.create_connection(("127.0.0.1", port), PATIENCE_S)
        self.stream.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._reader = FrameReader()
        self._received: list[Message] = []

    def send(self, *messages: Message) -> None:
        self.stream.sendall(b"".join(map(encode, messages)))

    def wait_for(self, *kinds: type[Message]) -> Message:
        """Return the next message of these classes; others are skipped."""
        deadline = Deadline()
        while not deadline.is_over:
            while self._received:
                message = self._received.pop(0)
                if isinstance(message, kinds):
                    return message
            self._read(deadline.left_s)
        raise TimeoutError(f"no {[kind.__name__ for kind in kinds]} within {PATIENCE_S} s")

    def ask(self, message: Message, *kinds: type[Message]) -> Message:
        self.send(message)
        return self.wait_for(*kinds)

    @property
    def is_closed_by_server(self) -> bool:
        """Wait until the server closes the connection; False if it does not."""
        self.stream.settimeout(PATIENCE_S)
        try:
            while self.stream.recv(1 << 16):
                pass
        except ConnectionError:
            return True
        except TimeoutError:
            return False
        return True

    def close(self) -> None:
        with contextlib.suppress(OSError):
            self.stream.close()

    def _read(self, timeout_s: float) -> None:
        self.stream.settimeout(max(timeout_s, 0.001))
        data = self.stream.recv(1 << 16)
        if not data:
            raise EOFError("the server has closed the connection")
        self._received += map(decode, self._reader.feed(data))
