"""Servers of the Foxglove protocol, each in a process of its own: this project's and the vendor's."""

from __future__ import annotations

import asyncio
import socket
import struct
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

STAMP = struct.Struct("<Q")
"""What each message begins with: the time of publishing in ns."""
CATCH_UP_S = 0.1
CHANNEL = {"topic": "/t", "encoding": "cdr", "schemaName": "t", "schema": "uint8[] data", "schemaEncoding": "ros2msg"}


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
    """The package whose constants the bridge uses, in its own event loop."""
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


def serve(library: str, port: str, rate: str, size: str) -> None:
    """Run a server (for a process of its own)."""
    SERVERS[library][1](int(port), float(rate), int(size))


@contextmanager
def running(library: str, rate: float, size: int) -> Iterator[tuple[int, int]]:
    """A library's server in a process of its own: port and process id."""
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    code = "import sys; from benchmarks.lib.bridge_servers import serve; serve(*sys.argv[1:])"
    command = [sys.executable, "-W", "ignore", "-c", code, library, str(port), str(rate), str(size)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as server:
        assert server.stdout is not None
        try:
            if server.stdout.readline() != "ready\n":
                raise SystemExit(f"{library} does not start")
            yield port, server.pid
        finally:
            server.kill()
