"""The bridge without ROS: delay, losses and CPU of messages to clients, beside one that does not read.

A worker publishes small messages, each alone in its millisecond, or in bursts of a hundredth of a second, as a
simulator does. Some clients read them, and one that has subscribed does not read; its buffers are full before the
measurement. The delay is from the publication to the client, which is in another process. CPU is that of the worker,
with the publication, for each message that a client gets. With `--against`, another checkout is measured in turn.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import json
import statistics
import time
from dataclasses import dataclass, field

from benchmarks.lib import rounds
from benchmarks.lib.bridge_servers import CHANNEL
from benchmarks.lib.report import Cell, Goal, Report, Table
from benchmarks.lib.rounds import BEFORE, NOW, Worker, sides, started

QUICK = {"rounds": 1, "seconds": 0.3, "clients": 2}
PATTERNS = {"1 message per ms": (1, 0.001), "bursts of 20 messages per 10 ms": (20, 0.01)}
SIZE, FLOOD_SIZE = 128, 1 << 16
"""Bytes of a message, and of those that fill the buffers of the client that does not read."""
FLOOD = 256
MOST_P99_MS, MOST_RATIO = 1.0, 1.3
_SUBSCRIBE = json.dumps({"op": "subscribe", "subscriptions": [{"id": 1, "channelId": CHANNEL}]}, separators=(",", ":"))
_DEADLINE_S = 60.0
_QUIET_S = 1.0
"""Time without a message after which the missing ones count as lost."""


@dataclass
class Figures:
    """What was measured with one pattern in one checkout."""

    delays_ms: list[float] = field(default_factory=list)
    p99_ms: list[float] = field(default_factory=list)
    """Of each round."""
    cpu_us: list[float] = field(default_factory=list)
    """Of each round, for each delivered message."""
    lost: int = 0


class Subscriber(asyncio.Protocol):
    """A client on a plain socket, so that it takes little of the processor; it notes the delay of each message."""

    def __init__(self) -> None:
        self.transport: asyncio.Transport
        self.is_open = asyncio.Event()
        self.delays_ms: list[float] = []
        self._bytes = bytearray()

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Ask for a WebSocket."""
        assert isinstance(transport, asyncio.Transport)
        self.transport = transport
        head = "Host: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
        key = "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n"
        transport.write(f"GET / HTTP/1.1\r\n{head}{key}".encode())

    def subscribe(self) -> None:
        """Subscribe to the channel."""
        data = _SUBSCRIBE.encode()
        self.transport.write(bytes([0x81, 0x80 | len(data)]) + bytes(4) + data)

    def data_received(self, data: bytes) -> None:
        """Read the frames that are whole."""
        now_ns = time.monotonic_ns()
        self._bytes += data
        if not self.is_open.is_set():
            end = self._bytes.find(b"\r\n\r\n")
            if end < 0:
                return
            del self._bytes[: end + 4]
            self.is_open.set()
        while (frame := self._frame()) is not None:
            if frame[0] == 1 and len(frame) < FLOOD_SIZE:  # opcode of message data; then the subscription and a time
                sent_ns = int.from_bytes(frame[13:21], "little")
                self.delays_ms.append((now_ns - sent_ns) / 1e6)

    def _frame(self) -> bytes | None:
        data = self._bytes
        if len(data) < 2:
            return None
        size, begin = data[1], 2
        if size >= 126:
            begin = 4 if size == 126 else 10
            if len(data) < begin:
                return None
            size = int.from_bytes(data[2:begin], "big")
        if len(data) < begin + size:
            return None
        frame = bytes(data[begin : begin + size])
        del data[: begin + size]
        return frame


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--clients", type=int, default=4, help="clients that read")
    parser.add_argument("--seconds", type=float, default=5.0, help="seconds of each measurement")
    parser.add_argument("--rounds", type=int, default=5, help="rounds; the figures are their medians")
    rounds.add_against(parser)


def measure(options: argparse.Namespace) -> Report:
    """Measure this checkout and the other one in turn."""
    found = {(side, pattern): Figures() for side in sides(options) for pattern in PATTERNS}
    with contextlib.ExitStack() as stack:
        workers = {
            side: started(stack, checkout, "lib.bridge_servers:bridge") for side, checkout in sides(options).items()
        }
        for _ in range(options.rounds):
            for pattern in PATTERNS:
                for side, worker in workers.items():
                    asyncio.run(one_round(worker, pattern, found[side, pattern], options))
    return _report(found)


async def one_round(worker: Worker, pattern: str, figures: Figures, options: argparse.Namespace) -> None:
    """Connect the clients, publish, and add what was measured."""
    port = worker("port")
    stalled = await subscriber(port)
    stalled.transport.pause_reading()
    await asyncio.to_thread(worker, "publish", FLOOD, 1, 0.002, FLOOD_SIZE)
    readers = [await subscriber(port) for _ in range(options.clients)]
    of, period_s = PATTERNS[pattern]
    bursts = max(1, round(options.seconds / period_s))
    cpu_s = await asyncio.to_thread(worker, "publish", bursts, of, period_s, SIZE)
    expected = bursts * of
    before = -1
    while before < (count := sum(len(one.delays_ms) for one in readers)) < expected * len(readers):
        before = count
        await asyncio.sleep(_QUIET_S)
    delays = [delay for one in readers for delay in one.delays_ms]
    figures.lost += expected * len(readers) - len(delays)
    figures.delays_ms += delays
    figures.p99_ms.append(statistics.quantiles(delays, n=100)[98])
    figures.cpu_us.append(1e6 * cpu_s / len(delays))
    for one in (stalled, *readers):
        one.transport.abort()


async def subscriber(port: int) -> Subscriber:
    """A client that has subscribed."""
    _, made = await asyncio.get_running_loop().create_connection(Subscriber, "127.0.0.1", port)
    await asyncio.wait_for(made.is_open.wait(), _DEADLINE_S)
    made.subscribe()
    await asyncio.sleep(0.1)
    return made


def _report(found: dict[tuple[str, str], Figures]) -> Report:
    names = {NOW: "", BEFORE: ", before"}
    rows: list[list[Cell]] = []
    goals: list[Goal] = []
    for (side, pattern), figures in found.items():
        p50, p99 = statistics.median(figures.delays_ms), statistics.median(figures.p99_ms)
        cpu_us = statistics.median(figures.cpu_us)
        rows.append([f"{pattern}{names[side]}", p50, p99, figures.lost, cpu_us])
        if side == NOW:
            goals.append(Goal(f"99 % of delays beside a client that does not read, {pattern}", MOST_P99_MS, p99, "ms"))
            goals.append(Goal(f"messages lost, {pattern}", 0, figures.lost))
            if (before := found.get((BEFORE, pattern))) is not None:
                ratio = cpu_us / statistics.median(before.cpu_us)
                goals.append(Goal(f"CPU of a message, now / before, {pattern}", MOST_RATIO, round(ratio, 2), "×"))
    head = ["", "median delay, ms", "99 % of delays, ms", "messages lost", "CPU of a delivered message, µs"]
    return Report([Table(head, rows)], goals)
