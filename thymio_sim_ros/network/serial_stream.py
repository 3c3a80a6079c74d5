"""A serial port as a socket, because event loops wait for sockets on every system, but not for serial ports.

One thread passes bytes from the port to the socket, another one from the socket to the port. A port that fails ends the
stream of the socket. The threads end, and close the port, when the event loop has closed its end of the socket.
"""

from __future__ import annotations

import contextlib
import socket
import threading
from typing import Any

__all__ = ["SerialStream"]

_LOOK_S = 0.2
"""Time between two looks whether the socket has been closed."""
_WRITE_S = 2.0
"""Time after which a port that accepts no bytes has failed."""
_CHUNK = 4096


class SerialStream:
    """A running pair of threads. `socket` is the end for the event loop, which closes it."""

    def __init__(self, device: str, baud_rate: int) -> None:
        """Open the port. Raises OSError."""
        import serial  # not needed without a serial port, and not on every machine

        self._port: Any = serial.Serial(device, baud_rate, timeout=_LOOK_S, write_timeout=_WRITE_S, exclusive=True)
        self.socket, self._inner = socket.socketpair()
        self._is_closed = threading.Event()
        self._receiving = threading.Thread(target=self._receive, name="serial-receive", daemon=True)
        self._sending = threading.Thread(target=self._send, name="serial-send", daemon=True)
        self._receiving.start()
        self._sending.start()

    def join(self, timeout_s: float) -> None:
        """Wait until all bytes of the closed socket have been sent and the port is closed."""
        self._sending.join(timeout_s)

    def _receive(self) -> None:
        with contextlib.suppress(OSError):
            while not self._is_closed.is_set():
                if data := self._port.read(max(1, min(self._port.in_waiting, _CHUNK))):
                    self._inner.sendall(data)
        self._shut_down()

    def _send(self) -> None:
        with contextlib.suppress(OSError):
            while data := self._inner.recv(_CHUNK):
                self._port.write(data)
        self._is_closed.set()
        self._shut_down()
        self._receiving.join()
        self._inner.close()
        self._port.close()

    def _shut_down(self) -> None:
        """End the stream for the event loop."""
        with contextlib.suppress(OSError):
            self._inner.shutdown(socket.SHUT_RDWR)
