"""CPU of the whole suite, with and without a viewer.

One robot follows the line. Measured in turn, CPU seconds of the suite's process per second: without clients, and with a
client that is subscribed to every topic of the shipped layout, to all parameters and to the graph, as if all panels
were open at once. CPU time is compared, because other work on the machine does not count in it. Needs ROS and the
built page.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import re
import statistics
import time

from websockets.asyncio.client import ClientConnection, connect

from benchmarks.lib.processes import cpu_s, suite
from benchmarks.lib.report import Goal, Report, Table
from thymio_sim_ros.bridge.protocol.constants import SUBPROTOCOLS
from thymio_sim_ros.studio_layout import render

QUICK = {"seconds": 1.0, "rounds": 1, "settle": 1.0}
MOST_PERCENT = 12.0
"""With all panels open."""
TRANSFORMS = {"/tf", "/tf_static"}


def layout_topics(advertised: dict[str, int]) -> list[str]:
    """Topics of the layout that are advertised."""
    named = {name.partition(".")[0] for name in re.findall(r'"(/[\w/.]+)', render("lichtblick"))}
    return sorted(topic for topic in advertised if topic in named | TRANSFORMS)


async def view(port: int, process: int, seconds: float, settle_s: float) -> tuple[float, int, int]:
    """CPU share with all panels open, topics subscribed, messages received."""
    async with connect(f"ws://localhost:{port}", subprotocols=SUBPROTOCOLS, compression=None, max_size=None) as client:
        channels: dict[str, int] = {}
        await receive(client, settle_s, channels)
        topics = layout_topics(channels)
        wanted = [{"id": number, "channelId": channels[topic]} for number, topic in enumerate(topics)]
        for message in (
            {"op": "subscribe", "subscriptions": wanted},
            {"op": "getParameters", "parameterNames": [], "id": "all"},
            {"op": "subscribeConnectionGraph"},
        ):
            await client.send(json.dumps(message))
        await receive(client, settle_s, channels)
        before_s, started_s = cpu_s(process), time.monotonic()
        count = await receive(client, seconds, channels)
        return (cpu_s(process) - before_s) / (time.monotonic() - started_s), len(topics), count


async def receive(client: ClientConnection, seconds: float, channels: dict[str, int]) -> int:
    """Read for some time and note what is advertised; return the number of messages."""
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


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--seconds", type=float, default=15.0, help="seconds of each measurement")
    parser.add_argument("--rounds", type=int, default=3, help="rounds; the figures are their medians")
    parser.add_argument("--settle", type=float, default=3.0, help="seconds between a change and the measurement")


def measure(options: argparse.Namespace) -> Report:
    """Measure both in turn."""
    quiet, watched, rates = [], [], []
    with suite("--program", "line_follower") as running:
        time.sleep(2 * options.settle)
        for _ in range(options.rounds):
            quiet.append(100 * alone(running.process.pid, options.seconds))
            viewing = view(running.bridge_port, running.process.pid, options.seconds, options.settle)
            share, topics, count = asyncio.run(viewing)
            watched.append(100 * share)
            rates.append(count / options.seconds)
    most = statistics.median(watched)
    rows = [
        ["no viewer", statistics.median(quiet), min(quiet), max(quiet), 0, 0],
        ["all panels open", most, min(watched), max(watched), topics, statistics.median(rates)],
    ]
    columns = ["% of a core", "median", "best", "worst", "topics", "messages/s"]
    return Report([Table(columns, rows)], [Goal("all panels open", MOST_PERCENT, most, "% CPU")])
