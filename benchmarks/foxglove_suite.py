"""CPU of the whole suite with a viewer: python benchmarks/foxglove_suite.py [--seconds S] [--rounds N]

One robot follows the line. Measured in turn, CPU seconds of the suite's process per second: without clients, and
with a client that is subscribed to every topic of the shipped layout, to all parameters and to the graph, as if all
panels were seen at once. CPU time is compared, since other work on the machine does not count in it.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import re
import socket
import subprocess
import sys
import time

from foxglove_latency import SUBPROTOCOLS, cpu_s
from websockets.asyncio.client import ClientConnection, connect

from thymio_sim_ros.studio_layout import render

SETTLE_S = 3.0
TRANSFORMS = {"/tf", "/tf_static"}


def layout_topics(advertised: dict[str, int]) -> list[str]:
    """Topics of the layout that are advertised."""
    named = {name.partition(".")[0] for name in re.findall(r'"(/[\w/.]+)', render("lichtblick"))}
    return sorted(topic for topic in advertised if topic in named | TRANSFORMS)


async def view(port: int, process: int, seconds: float) -> tuple[float, int, int]:
    """CPU share with all panels open, topics subscribed, messages received."""
    async with connect(f"ws://localhost:{port}", subprotocols=SUBPROTOCOLS, compression=None, max_size=None) as client:
        channels: dict[str, int] = {}
        await receive(client, SETTLE_S, channels)
        topics = layout_topics(channels)
        wanted = [{"id": number, "channelId": channels[topic]} for number, topic in enumerate(topics)]
        for message in (
            {"op": "subscribe", "subscriptions": wanted},
            {"op": "getParameters", "parameterNames": [], "id": "all"},
            {"op": "subscribeConnectionGraph"},
        ):
            await client.send(json.dumps(message))
        await receive(client, SETTLE_S, channels)
        before_s, started_s = cpu_s(process), time.monotonic()
        count = await receive(client, seconds, channels)
        return (cpu_s(process) - before_s) / (time.monotonic() - started_s), len(topics), count


async def receive(client: ClientConnection, seconds: float, channels: dict[str, int]) -> int:
    """Read for some time, noting what is advertised; how many messages came."""
    count = 0
    try:
        async with asyncio.timeout(seconds):
            while True:
                message = await client.recv()
                count += 1
                if isinstance(message, str):
                    for channel in json.loads(message).get("channels", ()):
                        channels[channel["topic"]] = channel["id"]
    except TimeoutError:
        return count


def alone(process: int, seconds: float) -> float:
    """CPU share without clients."""
    before_s, started_s = cpu_s(process), time.monotonic()
    time.sleep(seconds)
    return (cpu_s(process) - before_s) / (time.monotonic() - started_s)


def main() -> None:
    """Print a line for each round."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=15.0)
    parser.add_argument("--rounds", type=int, default=3)
    options = parser.parse_args()
    with socket.create_server(("127.0.0.1", 0)) as one, socket.create_server(("127.0.0.1", 0)) as two:
        ports = [str(free.getsockname()[1]) for free in (one, two)]
    start = "import sys; from thymio_sim_ros.cli.main import main; sys.exit(main())"
    command = [sys.executable, "-c", start, "--port", ports[0], "--foxglove-port", ports[1]]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=os.environ) as suite:
        try:
            assert suite.stdout is not None
            while "Stop" not in (line := suite.stdout.readline()):
                assert line, "the suite does not start"
            time.sleep(SETTLE_S)
            for number in range(options.rounds):
                quiet = alone(suite.pid, options.seconds)
                watched, topics, count = asyncio.run(view(int(ports[1]), suite.pid, options.seconds))
                viewer = f"{topics} topics with {count / options.seconds:.0f} messages/s"
                print(f"round {number + 1}: no client {quiet:.1%} of a core; {viewer}: {watched:.1%}", flush=True)
        finally:
            suite.terminate()


if __name__ == "__main__":
    main()
