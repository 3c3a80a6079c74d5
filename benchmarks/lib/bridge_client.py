"""A client of the bridge for benchmarks: frames of the protocol, and a blocking connection."""

from __future__ import annotations

import base64
import contextlib
import json
import os
import socket
import struct
import time
from collections.abc import Callable, Iterator

SUBPROTOCOLS = ["foxglove.sdk.v1", "foxglove.websocket.v1"]
ANSWER_S = 20.0
START_S = 60.0
TEXT, BINARY, PING, PONG = 0x81, 0x82, 0x89, 0x8A


def connected(port: int) -> socket.socket:
    """A connection after its handshake, of which no byte of a frame is read."""
    while True:
        try:
            peer = socket.create_connection(("127.0.0.1", port))
            break
        except ConnectionRefusedError:
            time.sleep(0.05)
    key = base64.b64encode(os.urandom(16)).decode()
    peer.sendall(
        b"GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        + f"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n".encode()
        + f"Sec-WebSocket-Protocol: {', '.join(SUBPROTOCOLS)}\r\n\r\n".encode()
    )
    answer = bytearray()
    while not answer.endswith(b"\r\n\r\n"):
        answer += peer.recv(1)
    return peer


def frames(peer: socket.socket) -> Iterator[tuple[int, memoryview]]:
    """Opcode and bytes of each frame, until the connection ends."""
    data = b""
    while True:
        start, view = 0, memoryview(data)
        while (found := frame_at(data, start)) is not None:
            begin, end = found
            yield data[start] & 0x0F, view[begin:end]
            start = end
        try:
            more = peer.recv(1 << 18)
        except OSError:
            return
        if not more:
            return
        data = data[start:] + more


def frame_at(data: bytes, start: int) -> tuple[int, int] | None:
    """Where the contents of the frame lie; None: it is not complete."""
    if len(data) < start + 2:
        return None
    size, begin = data[start + 1], start + 2
    if size >= 126:
        begin += 2 if size == 126 else 8
        if len(data) < begin:
            return None
        size = int.from_bytes(data[start + 2 : begin], "big")
    return (begin, begin + size) if begin + size <= len(data) else None


def frame(kind: int, body: bytes) -> bytes:
    """Return a client's frame, masked with zeros."""
    size = len(body)
    if size < 126:
        return bytes([kind, 0x80 | size, 0, 0, 0, 0]) + body
    if size < 1 << 16:
        return struct.pack("!BBH", kind, 0xFE, size) + bytes(4) + body
    return struct.pack("!BBQ", kind, 0xFF, size) + bytes(4) + body


def said(**message: object) -> bytes:
    """Return a text frame of the protocol."""
    return frame(TEXT, json.dumps(message).encode())


class Peer:
    """A blocking connection with the channels, services and parameters by name."""

    def __init__(self, port: int) -> None:
        self.socket = connected(port)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._data = b""
        self.channels: dict[str, int] = {}
        self.services: dict[str, int] = {}
        self.parameters: dict[str, object] = {}
        self.calls = 0

    def next(self, timeout_s: float) -> bytes:
        """Return the contents of the next frame; a ping is answered, and its contents are returned as well.

        Raises TimeoutError, or ConnectionError if the connection ended.
        """
        deadline = time.monotonic() + timeout_s
        while (found := frame_at(self._data, 0)) is None:
            left_s = deadline - time.monotonic()
            if left_s <= 0:
                raise TimeoutError
            self.socket.settimeout(left_s)
            more = self.socket.recv(1 << 20)
            if not more:
                raise ConnectionError("the server closed the connection")
            self._data += more
        begin, end = found
        kind, body, self._data = self._data[0], self._data[begin:end], self._data[end:]
        if kind == PING:
            self.socket.sendall(frame(PONG, body))
        if body.startswith(b"{"):
            self._note(json.loads(body))
        return body

    def _note(self, message: dict[str, list[dict[str, object]]]) -> None:
        for channel in message.get("channels", ()):
            self.channels[str(channel["topic"])] = int(str(channel["id"]))
        for service in message.get("services", ()):
            self.services[str(service["name"])] = int(str(service["id"]))
        for parameter in message.get("parameters", ()):
            self.parameters[str(parameter["name"])] = parameter.get("value")

    def until(self, condition: Callable[[], bool], what: str) -> None:
        """Read until the condition is true. Raises AssertionError after `START_S`."""
        deadline = time.monotonic() + START_S
        while not condition():
            assert time.monotonic() < deadline, f"no {what}"
            with contextlib.suppress(TimeoutError):
                self.next(0.1)

    def call(self, name: str, payload: bytes) -> float:
        """Call a service and return the seconds until its answer. Raises TimeoutError after `ANSWER_S`."""
        self.calls += 1
        began = time.monotonic()
        self.socket.settimeout(ANSWER_S)
        self.socket.sendall(request(self.services[name], self.calls, payload))
        while True:
            body = self.next(began + ANSWER_S - time.monotonic())
            # A ping of the server has four random bytes.
            if len(body) > 8 and body[0] == 3 and struct.unpack_from("<I", body, 5)[0] == self.calls:
                return time.monotonic() - began


def request(service: int, call: int, payload: bytes, encoding: bytes = b"cdr") -> bytes:
    """Return the frame of a service call."""
    return frame(BINARY, struct.pack("<BIII", 2, service, call, len(encoding)) + encoding + payload)
