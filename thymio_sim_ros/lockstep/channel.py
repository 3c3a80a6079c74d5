"""Channel: messages between the test and a program, one JSON object per line, over two pipes."""

from __future__ import annotations

import json
import os
from typing import Any

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["Channel", "ClosedError"]

_CHUNK = 65536


class ClosedError(ThymioSimError):
    """The other process has ended."""


class Channel:
    """One end of the connection."""

    def __init__(self, read_fd: int, write_fd: int) -> None:
        self.read_fd = read_fd
        self._write_fd = write_fd
        self._pending = b""

    def send(self, message: dict[str, Any]) -> None:
        """Send a message. Raises ClosedError if the other process has ended."""
        data = json.dumps(message).encode() + b"\n"
        try:
            while data:
                data = data[os.write(self._write_fd, data) :]
        except BrokenPipeError:
            raise ClosedError from None

    def receive(self) -> dict[str, Any]:
        """Wait for the next message. Raises ClosedError if the other process has ended."""
        while b"\n" not in self._pending:
            chunk = os.read(self.read_fd, _CHUNK)
            if not chunk:
                raise ClosedError
            self._pending += chunk
        line, _, self._pending = self._pending.partition(b"\n")
        message: dict[str, Any] = json.loads(line)
        return message

    def close(self) -> None:
        """Close both pipes."""
        os.close(self.read_fd)
        os.close(self._write_fd)
