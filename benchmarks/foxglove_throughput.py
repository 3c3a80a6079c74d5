"""As many messages as it goes, for a client that does nothing but count: python benchmarks/foxglove_throughput.py

The servers are those of `foxglove_latency.py`, each in a process of its own, without pacing. Printed are medians of the
rounds, in which the libraries take turns: messages per second that reached a client, and CPU time of the server's
process per delivery. What a server drops because the client cannot follow costs it time too.
"""

from __future__ import annotations

import argparse
import base64
import importlib.util
import json
import os
import socket
import statistics
import threading
import time
from collections.abc import Iterator

from foxglove_latency import SERVERS, SUBPROTOCOLS, cpu_s, running

TEXT, BINARY = 1, 2
MESSAGE_DATA = 1
SETTLE_S = 0.5


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


class Counter:
    """A client that counts its messages in a thread."""

    def __init__(self, port: int) -> None:
        self.count = 0
        self._peer = connected(port)
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Leave."""
        self._peer.shutdown(socket.SHUT_RDWR)
        self._thread.join()
        self._peer.close()

    def _run(self) -> None:
        for opcode, contents in frames(self._peer):
            if opcode == BINARY and contents[0] == MESSAGE_DATA:
                self.count += 1
            elif opcode == TEXT:
                message = json.loads(bytes(contents))
                if message["op"] == "advertise":
                    self._subscribe(message["channels"][0]["id"])

    def _subscribe(self, channel: int) -> None:
        text = json.dumps({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": channel}]}).encode()
        assert len(text) < 126
        self._peer.sendall(bytes([0x81, 0x80 | len(text), 0, 0, 0, 0]) + text)


def measure(library: str, size: int, clients: int, seconds: float) -> tuple[float, float]:
    """Messages per second that reached a client, CPU µs of the server per delivery."""
    with running(library, 0.0, size) as (port, process):
        counters = [Counter(port) for _ in range(clients)]
        time.sleep(SETTLE_S)
        before_s, before = cpu_s(process), sum(counter.count for counter in counters)
        started_s = time.monotonic()
        time.sleep(seconds)
        used_s, delivered = cpu_s(process) - before_s, sum(counter.count for counter in counters) - before
        took_s = time.monotonic() - started_s
        for counter in counters:
            counter.close()
    return delivered / clients / took_s, used_s * 1e6 / max(1, delivered)


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=3.0)
    options = parser.parse_args()
    libraries = [name for name, (module, _) in SERVERS.items() if importlib.util.find_spec(module) is not None]
    print(f"{'clients':>7} {'bytes':>6} {'library':20} {'messages/s':>10} {'CPU µs/delivery':>16}")
    for clients in (1, 10):
        for size in (100, 1000):
            found: dict[str, list[tuple[float, float]]] = {library: [] for library in libraries}
            for _ in range(options.rounds):
                for library in libraries:
                    found[library].append(measure(library, size, clients, options.seconds))
            for library, rounds in found.items():
                rate, cpu_us = (statistics.median(column) for column in zip(*rounds, strict=True))
                print(f"{clients:7} {size:6} {library:20} {rate:10.0f} {cpu_us:16.1f}", flush=True)


if __name__ == "__main__":
    main()
