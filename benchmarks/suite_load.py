"""Start, CPU and memory of the whole suite on an installed ROS 2 and on the embedded graph, with and without a viewer.

One robot follows the line, and the viewer is subscribed to every topic of the shipped layout, to all parameters and to
the graph, as if all panels were open at once. Several robots explore, and the viewer is subscribed to every topic that
is advertised. CPU is that of the suite's process per second, because other work on the machine does not count in it.
"Ready" is the time from the start of the process until a client of the bridge has the first odometry and the page is
served. Memory is the proportional set size without a viewer. Needs ROS and the built page.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import re
import statistics
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

from websockets.asyncio.client import ClientConnection, connect

from benchmarks.lib.processes import Suite, cpu_s, pss_mb, suite
from benchmarks.lib.report import Goal, Report, Table
from benchmarks.lib.scenes import grid
from thymio_sim_ros.bridge.protocol.constants import SUBPROTOCOLS
from thymio_sim_ros.studio_layout import render

QUICK = {"robots": [1, 2], "seconds": 1.0, "rounds": 1, "settle": 1.0}
GRAPHS = {"ROS 2": "--ros", "embedded": "--portable"}
MOST_READY_S = 1.5
MOST_PERCENT = {1: 5.0, 20: 10.0}
"""Without a viewer, by number of robots."""
GAP_M = 0.4
TRANSFORMS = {"/tf", "/tf_static"}


@dataclass
class Figures:
    """What was measured of one suite; shares are per round, in % of a core."""

    ready_s: float = 0.0
    megabytes: float = 0.0
    quiet: list[float] = field(default_factory=list)
    watched: list[float] = field(default_factory=list)
    rates: list[float] = field(default_factory=list)
    topics: int = 0


def layout_topics(advertised: dict[str, int]) -> list[str]:
    """Topics of the layout that are advertised."""
    named = {name.partition(".")[0] for name in re.findall(r'"(/[\w/.]+)', render("lichtblick"))}
    return sorted(topic for topic in advertised if topic in named | TRANSFORMS)


def connected(port: int) -> connect:
    """A client of the bridge."""
    return connect(f"ws://localhost:{port}", subprotocols=SUBPROTOCOLS, compression=None, max_size=None)


async def first_message(port: int, topic: str) -> float:
    """The time of the first message of a topic, s, by the monotonic clock."""
    async with connected(port) as client:
        async for message in client:
            if isinstance(message, bytes):
                return time.monotonic()
            for channel in json.loads(message).get("channels", ()):
                if channel["topic"] == topic:
                    wanted = [{"id": 0, "channelId": channel["id"]}]
                    await client.send(json.dumps({"op": "subscribe", "subscriptions": wanted}))
    raise RuntimeError(f"the bridge has closed the connection without a message on {topic}")


async def view(running: Suite, figures: Figures, options: argparse.Namespace, *, is_layout: bool) -> None:
    """Measure with all panels open, or with all topics subscribed."""
    async with connected(running.bridge_port) as client:
        channels: dict[str, int] = {}
        await receive(client, options.settle, channels)
        topics = layout_topics(channels) if is_layout else sorted(channels)
        wanted = [{"id": number, "channelId": channels[topic]} for number, topic in enumerate(topics)]
        for message in (
            {"op": "subscribe", "subscriptions": wanted},
            {"op": "getParameters", "parameterNames": [], "id": "all"},
            {"op": "subscribeConnectionGraph"},
        ):
            await client.send(json.dumps(message))
        await receive(client, options.settle, channels)
        before_s, started_s = cpu_s(running.process.pid), time.monotonic()
        count = await receive(client, options.seconds, channels)
        passed_s = time.monotonic() - started_s
        figures.watched.append(100 * (cpu_s(running.process.pid) - before_s) / passed_s)
        figures.rates.append(count / passed_s)
        figures.topics = len(topics)


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
    """CPU share without clients, in % of a core."""
    before_s, started_s = cpu_s(process), time.monotonic()
    time.sleep(seconds)
    return 100 * (cpu_s(process) - before_s) / (time.monotonic() - started_s)


def per_message(figures: Figures) -> float:
    """CPU share per message and second with a viewer."""
    return statistics.median(figures.watched) / statistics.median(figures.rates)


def measure_suite(graph: str, robots: int, options: argparse.Namespace) -> Figures:
    """Measure the suite on a graph with so many robots."""
    figures = Figures()
    with tempfile.TemporaryDirectory() as folder:
        arguments = ["--program", "line_follower"]
        if robots > 1:
            file = Path(folder, "robots.json")
            file.write_text(grid(robots, GAP_M, walls=True), encoding="utf-8")
            arguments = ["--program", "explorer", "--playground", str(file)]
        began_s = time.monotonic()
        with suite(GRAPHS[graph], *arguments) as running:
            first_s = asyncio.run(first_message(running.bridge_port, "/odom" if robots == 1 else "/r0/odom"))
            figures.ready_s = first_s - began_s
            time.sleep(2 * options.settle)
            figures.quiet = [alone(running.process.pid, options.seconds) for _ in range(options.rounds)]
            figures.megabytes = pss_mb(running.process.pid)
            for _ in range(options.rounds):  # afterwards, because the subscriptions of a viewer end after it
                asyncio.run(view(running, figures, options, is_layout=robots == 1))
    return figures


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--robots", type=int, nargs="+", default=[1, 20], help="numbers of robots")
    parser.add_argument("--seconds", type=float, default=15.0, help="seconds of each measurement")
    parser.add_argument("--rounds", type=int, default=3, help="rounds; the figures are their medians")
    parser.add_argument("--settle", type=float, default=3.0, help="seconds between a change and the measurement")


def measure(options: argparse.Namespace) -> Report:
    """Measure each number of robots on both graphs."""
    rows: list[list[str | float | int]] = []
    goals = []
    for robots in options.robots:
        found = {graph: measure_suite(graph, robots, options) for graph in GRAPHS}
        for graph, one in found.items():
            quiet, watched, rate = map(statistics.median, (one.quiet, one.watched, one.rates))
            rows.append([graph, robots, one.ready_s, one.megabytes, quiet, watched, one.topics, rate])
        embedded, installed = found["embedded"], found["ROS 2"]
        if robots == 1:
            goals.append(Goal("1 robot, ready, embedded graph", MOST_READY_S, embedded.ready_s, "s"))
        if robots in MOST_PERCENT:
            share = statistics.median(embedded.quiet)
            goals.append(Goal(f"robots: {robots}, no viewer, embedded graph", MOST_PERCENT[robots], share, "% CPU"))
        ratio = per_message(embedded) / per_message(installed)
        goals.append(Goal(f"robots: {robots}, viewer, CPU per message, embedded graph to ROS 2", 1.0, ratio, "×"))
    columns = ["graph", "robots", "ready, s", "MB", "no viewer, % CPU", "viewer, % CPU", "topics", "messages/s"]
    return Report([Table(columns, rows)], goals)
