"""The bridge's server beside the servers of the vendor.

Each library runs in a process of its own and sends messages of one channel; clients count here. In the first table
the stream is paced: share of messages that arrived at healthy clients, latency from the call that publishes to the
client's read, and CPU of the server's process per delivery, less what the same process needs to pace the stream without
clients. In the second one it is not paced: messages per second that reached a client, and CPU per delivery; a message
that a server drops because the client cannot follow costs time, too. The libraries take turns, and the figures are
medians of the rounds. foxglove-sdk and foxglove-websocket are measured where they are installed.
"""

from __future__ import annotations

import argparse
import asyncio
import importlib.util
import json
import math
import socket
import statistics
import threading
import time
from dataclasses import astuple, dataclass

from websockets.asyncio.client import ClientConnection, connect

from benchmarks.lib.bridge_client import SUBPROTOCOLS, connected, frames
from benchmarks.lib.bridge_servers import SERVERS, STAMP, running
from benchmarks.lib.processes import cpu_s
from benchmarks.lib.report import Report, Table

QUICK = {"rounds": 1, "seconds": 0.2, "warm_up": 0.1, "rate": 100.0}
TEXT_FRAME, BINARY_FRAME = 1, 2
MESSAGE_DATA = 1
STUCK_S = 10.0
"""A scene that takes this much longer than it should is given up: its server does not answer."""
HEADER = 1 + 4 + 8  # opcode, subscription, time


@dataclass(frozen=True)
class Result:
    """One library in one round of a scene; latencies in ms, CPU time of the server's process in µs per delivery."""

    arrived: float
    p50: float
    p99: float
    cpu_us: float


async def subscribe(port: int) -> ClientConnection:
    """Connect and subscribe to the only channel."""
    while True:
        try:
            connection = await connect(f"ws://127.0.0.1:{port}", subprotocols=SUBPROTOCOLS, compression=None)
            break
        except ConnectionRefusedError:  # foxglove-websocket listens some time after it says so
            await asyncio.sleep(0.05)
    while True:
        message = await connection.recv()
        if isinstance(message, str) and json.loads(message)["op"] == "advertise":
            channel = json.loads(message)["channels"][0]["id"]
            await connection.send(json.dumps({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": channel}]}))
            return connection


async def count(connection: ClientConnection, until_s: float, latencies_ms: list[float]) -> None:
    """Note the latency of each message until then."""
    try:
        async with asyncio.timeout_at(until_s):
            while True:
                message = await connection.recv()
                if isinstance(message, bytes) and message[0] == 1:
                    (sent_ns,) = STAMP.unpack_from(message, HEADER)
                    latencies_ms.append((time.monotonic_ns() - sent_ns) / 1e6)
    except TimeoutError:
        return


async def watch(
    port: int, process: int, options: argparse.Namespace, healthy: int, stalled: int
) -> tuple[list[list[float]], float]:
    """Latencies seen by each healthy client, and the CPU seconds that the process took, once all have been served."""
    blocked = [await subscribe(port) for _ in range(stalled)]
    for connection in blocked:
        connection.transport.pause_reading()
    connections = [await subscribe(port) for _ in range(healthy)]
    await read(connections, options.warm_up)
    before_s = cpu_s(process)
    seen = await read(connections, options.seconds)
    used_s = cpu_s(process) - before_s
    for connection in (*connections, *blocked):
        connection.transport.abort()
    return seen, used_s


async def read(connections: list[ClientConnection], seconds: float) -> list[list[float]]:
    """The latencies of what each connection gets in so long."""
    until_s = asyncio.get_running_loop().time() + seconds
    seen: list[list[float]] = [[] for _ in connections]
    await asyncio.gather(
        asyncio.sleep(seconds), *(count(one, until_s, found) for one, found in zip(connections, seen, strict=True))
    )
    return seen


def paced(library: str, options: argparse.Namespace, healthy: int, stalled: int, idle_us: float = 0.0) -> Result:
    """Run one scene; `idle_us`: CPU time per message that pacing takes."""
    with running(library, options.rate, options.size) as (port, process):
        scene = watch(port, process, options, healthy, stalled)
        try:
            seen, used_s = asyncio.run(asyncio.wait_for(scene, options.warm_up + options.seconds + STUCK_S))
        except TimeoutError:
            seen, used_s = [], math.nan
    latencies = sorted(latency for one in seen for latency in one) or [math.nan] * 2
    ranks = statistics.quantiles(latencies, n=100, method="inclusive")
    deliveries = sum(len(one) for one in seen)
    sent = options.rate * options.seconds
    expected = options.rate * options.seconds * max(1, healthy)
    return Result(
        deliveries / expected, ranks[49], ranks[98], (used_s * 1e6 - idle_us * sent) / (deliveries or round(sent))
    )


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
            if opcode == BINARY_FRAME and contents[0] == MESSAGE_DATA:
                self.count += 1
            elif opcode == TEXT_FRAME:
                message = json.loads(bytes(contents))
                if message["op"] == "advertise":
                    self._subscribe(message["channels"][0]["id"])

    def _subscribe(self, channel: int) -> None:
        text = json.dumps({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": channel}]}).encode()
        assert len(text) < 126
        self._peer.sendall(bytes([0x81, 0x80 | len(text), 0, 0, 0, 0]) + text)


def unpaced(library: str, size: int, clients: int, options: argparse.Namespace) -> tuple[float, float]:
    """Messages per second that reached a client, CPU µs of the server per delivery."""
    with running(library, 0.0, size) as (port, process):
        counters = [Counter(port) for _ in range(clients)]
        time.sleep(options.warm_up)
        before_s, before = cpu_s(process), sum(counter.count for counter in counters)
        started_s = time.monotonic()
        time.sleep(options.seconds)
        used_s, delivered = cpu_s(process) - before_s, sum(counter.count for counter in counters) - before
        took_s = time.monotonic() - started_s
        for counter in counters:
            counter.close()
    return delivered / clients / took_s, used_s * 1e6 / max(1, delivered)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--rounds", type=int, default=5, help="rounds; the figures are their medians")
    parser.add_argument("--seconds", type=float, default=5.0, help="seconds of each measurement")
    parser.add_argument("--warm-up", type=float, default=0.5, help="seconds before the measurement")
    parser.add_argument("--rate", type=float, default=1000.0, help="messages per second of the paced stream")
    parser.add_argument("--size", type=int, default=1000, help="bytes per message of the paced stream")


def measure(options: argparse.Namespace) -> Report:
    """Measure both tables."""
    libraries = [name for name, (module, _) in SERVERS.items() if importlib.util.find_spec(module) is not None]
    title = f"{options.rate:g} messages/s of {options.size} bytes"
    columns = ["", "delivered, %", "p50, ms", "p99, ms", "worst p99, ms", "CPU, µs per delivery"]
    unpaced_columns = [
        "CPU, µs per delivery; clients and bytes",
        *libraries,
        *(f"{one}: messages/s" for one in libraries),
    ]
    return Report(
        [
            Table(columns, _paced_rows(libraries, options), title),
            Table(unpaced_columns, _unpaced_rows(libraries, options), "As many messages as possible"),
        ]
    )


def _paced_rows(libraries: list[str], options: argparse.Namespace) -> list[list[str | float]]:
    scenes = {"1 client": (1, 0), "10 clients": (10, 0), "1 beside a stalled one": (1, 1)}
    results: dict[tuple[str, str], list[Result]] = {}
    for _ in range(options.rounds):
        idle_us = {library: paced(library, options, 0, 0).cpu_us for library in libraries}
        for scene, (healthy, stalled) in scenes.items():
            for library in libraries:
                found = paced(library, options, healthy, stalled, idle_us[library])
                results.setdefault((scene, library), []).append(found)
    rows: list[list[str | float]] = []
    for (scene, library), rounds in results.items():
        arrived, p50, p99, cpu_us = (statistics.median(column) for column in zip(*map(astuple, rounds), strict=True))
        worst = max(result.p99 for result in rounds)
        rows.append([f"{scene}: {library}", 100 * arrived, p50, p99, worst, cpu_us])
    return rows


def _unpaced_rows(libraries: list[str], options: argparse.Namespace) -> list[list[str | float]]:
    rows: list[list[str | float]] = []
    for clients in (1, 10):
        for size in (100, 1000):
            found: dict[str, list[tuple[float, float]]] = {library: [] for library in libraries}
            for _ in range(options.rounds):
                for library in libraries:
                    found[library].append(unpaced(library, size, clients, options))
            rates, costs = zip(
                *(map(statistics.median, zip(*found[one], strict=True)) for one in libraries), strict=True
            )
            rows.append([f"{clients} × {size}", *costs, *rates])
    return rows
