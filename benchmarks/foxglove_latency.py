"""The bridge's server beside the vendor's: python benchmarks/foxglove_latency.py [--rounds N] [--seconds S] [--rate HZ]

Each library runs in a process of its own and sends the same stream; clients count here. Measured per scene: share of
messages that arrived at healthy clients, latency from the call that publishes to the client's read, and CPU of the
server's process per delivery, less what the same process needs to pace the stream without clients. The libraries take
turns,
and medians of the rounds are printed, so that other work on the machine meets all of them. Libraries that are not
installed are left out (foxglove-sdk, foxglove-websocket). `foxglove_throughput.py` measures without pacing.
"""

from __future__ import annotations

import argparse
import asyncio
import importlib.util
import json
import socket
import statistics
import struct
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import astuple, dataclass
from pathlib import Path

from websockets.asyncio.client import ClientConnection, connect

SUBPROTOCOLS = ["foxglove.sdk.v1", "foxglove.websocket.v1"]
STAMP = struct.Struct("<Q")
CATCH_UP_S = 0.1
WARM_UP_S = 0.5
"""What a connection costs at its begin is not counted."""
STUCK_S = 10.0
"""A scene that takes this much longer than it should is given up: its server does not answer."""
HEADER = 1 + 4 + 8  # opcode, subscription, time
CHANNEL = {"topic": "/t", "encoding": "cdr", "schemaName": "t", "schema": "uint8[] data", "schemaEncoding": "ros2msg"}


# --- servers: each prints "ready" and streams until it is killed ---


def ticks(rate: float) -> Iterator[None]:
    """One turn per message, with absolute deadlines, for ever; rate 0: as fast as it goes."""
    print("ready", flush=True)
    due = time.monotonic()
    while True:
        if rate:
            due = next_due(due, rate)
            time.sleep(max(0.0, due - time.monotonic()))
        yield


def next_due(due: float, rate: float) -> float:
    """The next deadline; what is more than `CATCH_UP_S` late is given up."""
    return max(due + 1 / rate, time.monotonic() - CATCH_UP_S)


def payload(size: int) -> bytes:
    """The time of publishing and padding."""
    return STAMP.pack(time.monotonic_ns()) + bytes(size - STAMP.size)


def serve_ours(port: int, rate: float, size: int) -> None:
    """The server of this project, fed from another thread as the node does it."""
    from thymio_sim_ros.bridge import ServerInfo, ServerThread
    from thymio_sim_ros.bridge.protocol import messages
    from thymio_sim_ros.bridge.switchboard import events

    class Sink:
        def is_full(self, client: int) -> bool:
            """Never."""
            return False

        def post(self, event: events.Event) -> None:
            """Ignore the message."""

    server = ServerThread(ServerInfo("ours", ()), Sink(), port=port)
    channel = messages.Channel(1, CHANNEL["topic"], "cdr", "t", CHANNEL["schema"], "ros2msg")
    server.post(events.AddChannels((channel,)))
    for _ in ticks(rate):
        server.publish(1, 0, payload(size))


def serve_foxglove_websocket(port: int, rate: float, size: int) -> None:
    """The package that gave the vocabulary, in its own event loop."""
    from foxglove_websocket.server import FoxgloveServer

    async def run() -> None:
        async with FoxgloveServer("127.0.0.1", port, "theirs") as server:
            number = await server.add_channel(CHANNEL)
            print("ready", flush=True)
            due = time.monotonic()
            while True:
                if rate:
                    due = next_due(due, rate)
                await asyncio.sleep(max(0.0, due - time.monotonic()) if rate else 0)
                await server.send_message(number, 0, payload(size))

    asyncio.run(run())


def serve_foxglove_sdk(port: int, rate: float, size: int) -> None:
    """The vendor's successor."""
    import foxglove

    foxglove.start_server(host="127.0.0.1", port=port)
    schema = foxglove.Schema(name="t", encoding="ros2msg", data=CHANNEL["schema"].encode())
    channel = foxglove.Channel(CHANNEL["topic"], schema=schema, message_encoding="cdr")
    for _ in ticks(rate):
        channel.log(payload(size), log_time=0)


SERVERS: dict[str, tuple[str, Callable[[int, float, int], None]]] = {
    "ours": ("thymio_sim_ros", serve_ours),
    "foxglove-websocket": ("foxglove_websocket", serve_foxglove_websocket),
    "foxglove-sdk": ("foxglove", serve_foxglove_sdk),
}


# --- clients and measurement ---


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


async def watch(port: int, process: int, seconds: float, healthy: int, stalled: int) -> tuple[list[list[float]], float]:
    """Latencies seen by each healthy client, and the CPU seconds that the process took, once all have been served."""
    blocked = [await subscribe(port) for _ in range(stalled)]
    for connection in blocked:
        connection.transport.pause_reading()
    connections = [await subscribe(port) for _ in range(healthy)]
    await read(connections, WARM_UP_S)
    before_s = cpu_s(process)
    seen = await read(connections, seconds)
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


@contextmanager
def running(library: str, rate: float, size: int) -> Iterator[tuple[int, int]]:
    """A library's server in a process of its own: port and process id."""
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    command = [sys.executable, "-W", "ignore", str(Path(__file__).with_name("foxglove_latency.py"))]
    command += ["--serve", library, "--port", str(port), "--rate", str(rate), "--size", str(size)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as server:
        assert server.stdout is not None
        try:
            if server.stdout.readline() != "ready\n":
                raise SystemExit(f"{library} does not start")
            yield port, server.pid
        finally:
            server.kill()


def measure(library: str, options: argparse.Namespace, healthy: int, stalled: int, idle_us: float = 0.0) -> Result:
    """Run one scene; `idle_us`: CPU time per message that pacing takes."""
    with running(library, options.rate, options.size) as (port, process):
        scene = watch(port, process, options.seconds, healthy, stalled)
        try:
            seen, used_s = asyncio.run(asyncio.wait_for(scene, WARM_UP_S + options.seconds + STUCK_S))
        except TimeoutError:
            seen, used_s = [], float("nan")
    latencies = sorted(latency for one in seen for latency in one) or [float("nan")] * 2
    ranks = statistics.quantiles(latencies, n=100, method="inclusive")
    deliveries = sum(len(one) for one in seen)
    sent = options.rate * options.seconds
    expected = options.rate * options.seconds * max(1, healthy)
    return Result(
        deliveries / expected, ranks[49], ranks[98], (used_s * 1e6 - idle_us * sent) / (deliveries or round(sent))
    )


def cpu_s(process: int) -> float:
    """CPU seconds of a process so far, as the scheduler counts them: ticks of 10 ms are wrong for short turns."""
    tasks = Path(f"/proc/{process}/task").glob("*/schedstat")
    return sum(int(task.read_text(encoding="ascii").split()[0]) for task in tasks) / 1e9


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=5.0)
    parser.add_argument("--rate", type=float, default=1000.0, help="messages per second")
    parser.add_argument("--size", type=int, default=1000, help="bytes per message")
    parser.add_argument("--serve", choices=SERVERS, help=argparse.SUPPRESS)
    parser.add_argument("--port", type=int, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.serve:
        SERVERS[options.serve][1](options.port, options.rate, options.size)
        return
    libraries = [name for name, (module, _) in SERVERS.items() if importlib.util.find_spec(module) is not None]
    scenes = {"1 client": (1, 0), "10 clients": (10, 0), "1 beside a stalled one": (1, 1)}
    results: dict[tuple[str, str], list[Result]] = {}
    for _ in range(options.rounds):
        idle_us = {library: measure(library, options, 0, 0).cpu_us for library in libraries}
        for scene, (healthy, stalled) in scenes.items():
            for library in libraries:
                found = measure(library, options, healthy, stalled, idle_us[library])
                results.setdefault((scene, library), []).append(found)
    print(f"{options.rate:g} messages/s of {options.size} bytes, medians of {options.rounds} rounds")
    print(f"{'scene':24} {'library':20} {'arrived':>8} {'p50 ms':>8} {'p99 ms':>8} {'worst p99':>9} {'CPU µs':>8}")
    for (scene, library), found in results.items():
        arrived, p50, p99, cpu_us = (statistics.median(column) for column in zip(*map(astuple, found), strict=True))
        worst = max(result.p99 for result in found)
        print(f"{scene:24} {library:20} {arrived:8.1%} {p50:8.2f} {p99:8.2f} {worst:9.2f} {cpu_us:8.1f}")


if __name__ == "__main__":
    main()
