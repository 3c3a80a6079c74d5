"""A class on this machine: CPU, memory and pace with so many pupils, while the teacher's page is open.

All robots drive. The teacher's page is a client that asks for the state twice per second, as the page does; no pupil's
page is open. "Server" is the process that supervises the suites. Memory is the proportional set size (PSS): what suites
share counts once. A pupil's suite keeps up if its real-time factor, over about the last second, is at least 0.95; the
figure is the part of all readings.

Then each pupil has a viewer that is subscribed to all topics, in turns through the port of the class and directly at
the port of the suite, which only this computer reaches. The last column is the quotient of the CPU of all processes of
the class.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import statistics
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from websockets.asyncio.client import connect

from benchmarks.lib.processes import cpu_s, pss_mb
from benchmarks.lib.report import Goal, Report, Table
from tests.classroom.class_support import RunningClass
from thymio_sim_ros.bridge.protocol.constants import SUBPROTOCOLS

QUICK = {"pupils": [2], "seconds": 2.0, "turns": 1}
POLL_S = 0.5
KEEPS_UP = 0.95
LEAST_PERCENT = 95.0
"""Readings of twenty pupils that keep up."""
PUPILS = 30
MOST_RATIO = 1.2
"""CPU of a class with viewers through its port, compared with viewers at the ports of the suites."""


COLUMNS = (
    *("pupils", "start, s", "a suite, % CPU", "server, % CPU", "all, % CPU", "a suite, MB", "real-time factor"),
    *("keep up, %", "viewers, one port, % CPU", "viewers, direct, % CPU", "one port / direct"),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--pupils", type=int, nargs="+", default=[1, 10, 20, 30], help="numbers of pupils")
    parser.add_argument("--seconds", type=float, default=20.0, help="seconds of each measurement")
    parser.add_argument("--turns", type=int, default=3, help="measurements with viewers through the port, and directly")
    parser.add_argument("--program", default="explorer", help="program of all robots")
    parser.add_argument("--ros", action="store_true", help="each robot in a ROS domain of its own")


def measure(options: argparse.Namespace) -> Report:
    """Measure a class of each size."""
    rows, goals = [], []
    for count in options.pupils:
        row = one_class(count, options)
        rows.append(row)
        if count == PUPILS:
            kept_up, ratio = row[COLUMNS.index("keep up, %")], row[-1]
            goals.append(Goal(f"{PUPILS} pupils in real time", LEAST_PERCENT, round(kept_up, 1), "%", is_least=True))
            goals.append(Goal(f"one port / direct, {PUPILS} viewers", MOST_RATIO, round(ratio, 2), "×"))
    return Report([Table(COLUMNS, rows)], goals)


def one_class(count: int, options: argparse.Namespace) -> list[Any]:
    """Measure one class; return a row of the table."""
    names = [f"pupil {number}" for number in range(1, count + 1)]
    arguments = ["--program", options.program, *(["--ros"] if options.ros else [])]
    with tempfile.TemporaryDirectory() as folder:
        began_s = time.monotonic()
        running = RunningClass(Path(folder), names, arguments=tuple(arguments))
        try:
            for pupil in running.state():
                running.until(pupil["id"], lambda one: one["phase"] == "running" and one["programs"])
            start_s = time.monotonic() - began_s
            return [count, start_s, *_alone(running, options.seconds), *_with_viewers(running, options)]
        finally:
            running.end()


def _alone(running: RunningClass, seconds: float) -> list[float]:
    """Figures without pages of pupils."""
    time.sleep(min(5.0, seconds))  # the factor is over the last second: the start is not part of it
    suites = [one.pid for one in running.suites()]
    processes = [running.process.pid, *suites]
    before = [cpu_s(pid) for pid in processes]
    begin_s = time.monotonic()
    factors: list[float] = []
    while time.monotonic() - begin_s < seconds:
        factors += [pupil["achieved"] for pupil in running.state()]
        time.sleep(POLL_S)
    passed_s = time.monotonic() - begin_s
    server, *shares = [100 * (cpu_s(pid) - old) / passed_s for pid, old in zip(processes, before, strict=True)]
    kept_up = 100 * sum(factor >= KEEPS_UP for factor in factors) / len(factors)
    memory = statistics.median(map(pss_mb, suites))
    return [statistics.median(shares), server, server + sum(shares), memory, statistics.median(factors), kept_up]


def _with_viewers(running: RunningClass, options: argparse.Namespace) -> list[float]:
    """CPU of all processes with viewers through the port and directly, and the quotient."""
    pupils = [pupil["id"] for pupil in running.state()]
    through = [running.bridge_of(pupil) for pupil in pupils]
    direct = [f"ws://127.0.0.1:{running.suite_port(pupil)}/?token={running.token_of(pupil)}" for pupil in pupils]
    shares = [
        [asyncio.run(_viewed(running, addresses, options.seconds)) for addresses in (through, direct)]
        for _ in range(options.turns)
    ]
    one_port, at_suites = (statistics.median(turn) for turn in zip(*shares, strict=True))
    return [one_port, at_suites, one_port / at_suites]


async def _viewed(running: RunningClass, addresses: Sequence[str], seconds: float) -> float:
    """CPU of all processes while a viewer at each address receives all topics, in % of a core."""
    async with asyncio.TaskGroup() as group:
        viewers = [group.create_task(_view(address)) for address in addresses]
        await asyncio.sleep(min(3.0, seconds))
        processes = [running.process.pid, *(one.pid for one in running.suites())]
        before_s, begin_s = sum(map(cpu_s, processes)), time.monotonic()
        await asyncio.sleep(seconds)
        share = 100 * (sum(map(cpu_s, processes)) - before_s) / (time.monotonic() - begin_s)
        for viewer in viewers:
            viewer.cancel()
    return share


async def _view(address: str) -> None:
    """Subscribe to each topic as soon as it is advertised, and receive."""
    async with connect(address, subprotocols=SUBPROTOCOLS, compression=None, max_size=None) as client:
        async for message in client:
            if isinstance(message, str) and (channels := json.loads(message).get("channels")):
                wanted = [{"id": channel["id"], "channelId": channel["id"]} for channel in channels]
                await client.send(json.dumps({"op": "subscribe", "subscriptions": wanted}))
