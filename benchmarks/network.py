"""Aseba ports: an event from a client to a program and back in ms, and sixteen robots whose clients poll at 10 Hz.

Each robot has a client of its own in another process, which reads all variables ten times per second, as Studio and
thymiodirect do. In the rows with a flood, other clients send requests to the first robot without pause, and the second
robot is polled. "Simulated time" is the time that a timer of the first robot's program counts, per wall time. Needs
ROS.
"""

from __future__ import annotations

import argparse
import contextlib
import random
import statistics
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from aseba_vm.protocol import GetVariables, ListNodes, NodePresent, UserMessage, Variables
from benchmarks.lib.flood import flooded
from benchmarks.lib.report import Goal, Report, Table
from benchmarks.lib.scenes import grid
from tests.network.aseba_client import AsebaClient
from tests.processes import Process, free_port, wait_for_port
from thymio_sim_ros.device.layout import target

QUICK = {"events": 5, "seconds": 0.5, "robots": 2}
SUITE = "thymio_sim_ros.cli.main"
GAP_M = 0.4
PROGRAM = """<network><event size="1" name="ping"/><event size="1" name="pong"/>
<node name="thymio-II">var n = 0
timer.period[0] = 100
onevent timer0
n += 1
onevent ping
emit pong event.args[0]
</node></network>"""
PING, PONG = 0, 1
TICK_S = 0.1
"""Period of the program's timer."""
PERIOD_S = 0.1
"""Period of the polls of a client."""
PAUSE_S = (0.01, 0.05)
MANY = 30
"""Clients that flood a robot together; a port accepts 32."""
ALLOWED_MS = 15.0
"""An event takes at most this in 99 of 100."""


def latency(client: AsebaClient, count: int) -> list[float]:
    """Milliseconds from sending an event to the answer of the program; at any phase of a tick."""
    pauses, waits = random.Random(1), []
    for number in range(count + 2):
        time.sleep(pauses.uniform(*PAUSE_S))
        begin_s = time.monotonic()
        client.send(UserMessage(0, PING, (number,)))
        while client.wait_for(UserMessage) != UserMessage(1, PONG, (number,)):
            pass
        waits.append(1000.0 * (time.monotonic() - begin_s))
    return waits[2:]  # the first ones fill caches


def poll(clients: list[AsebaClient], seconds: float) -> tuple[list[float], int, float]:
    """Poll all robots; return milliseconds of each answer, the number of late polls, and simulated per wall time."""
    counter = GetVariables(0, 1, target().variables_end, 1)
    waits, late = [], 0
    first = clients[0].ask(counter, Variables).values[0]
    begin_s = time.monotonic()
    due_s = begin_s
    while time.monotonic() - begin_s < seconds:
        sent_s = time.monotonic()
        for number, client in enumerate(clients, start=1):
            client.send(GetVariables(0, number, 0, 256), GetVariables(0, number, 256, 256))
        for client in clients:
            for _ in range(2):
                client.wait_for(Variables)
            waits.append(1000.0 * (time.monotonic() - sent_s))
        due_s += PERIOD_S
        late += time.monotonic() > due_s
        time.sleep(max(due_s - time.monotonic(), 0.0))
    passed_s = time.monotonic() - begin_s
    counted = clients[0].ask(counter, Variables).values[0] - first
    return waits, late, counted * TICK_S / passed_s


def flood_waits(client: AsebaClient, seconds: float) -> list[float]:
    """Milliseconds of requests to the second robot, in ascending order."""
    pauses, waits = random.Random(2), []
    end_s = time.monotonic() + seconds
    while time.monotonic() < end_s:
        time.sleep(pauses.uniform(*PAUSE_S))
        begin_s = time.monotonic()
        client.ask(GetVariables(0, 2, 0, 256), Variables)
        waits.append(1000.0 * (time.monotonic() - begin_s))
    return sorted(waits)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--events", type=int, default=500, help="events that are sent")
    parser.add_argument("--robots", type=int, default=16, help="robots with a client each")
    parser.add_argument("--seconds", type=float, default=20.0, help="duration of the polls")


@contextlib.contextmanager
def served(robots: int) -> Iterator[list[AsebaClient]]:
    """A suite with so many robots, and a client of each."""
    with tempfile.TemporaryDirectory() as folder:
        world, program = Path(folder) / "grid.json", Path(folder) / "program.aesl"
        world.write_text(grid(robots, GAP_M), encoding="utf-8")
        program.write_text(PROGRAM, encoding="utf-8")
        port = free_port()
        files = ("--playground", str(world), "--program", str(program))
        process = Process(Path(folder), SUITE, "--headless", "--no-announcement", "--aseba-port", str(port), *files)
        clients = []
        try:
            for number in range(robots):
                wait_for_port(port + number)
                clients.append(AsebaClient(port + number))
                clients[-1].ask(ListNodes(0, 5), NodePresent)
            yield clients
        finally:
            for client in clients:
                client.close()
            process.end()


def measure(options: argparse.Namespace) -> Report:
    """Measure a suite with one robot, then one with all."""
    with served(1) as clients:
        waits = sorted(latency(clients[0], options.events))
    with served(options.robots) as clients:
        polls, late, factor = poll(clients, options.seconds)
    with served(2) as clients, flooded(clients[0].port):
        beside = flood_waits(clients[1], options.seconds)
    with served(2) as clients, flooded(clients[0].port, MANY):
        beside_many = flood_waits(clients[1], options.seconds)
    polls.sort()
    rows = [
        ["an event and its answer, one robot", *_quantiles(waits)],
        [f"{options.robots} robots, 512 words each, 10 Hz", *_quantiles(polls)],
        ["a robot beside one that is flooded", *_quantiles(beside)],
        [f"a robot beside one that {MANY} clients flood", *_quantiles(beside_many)],
    ]
    p99 = waits[int(0.99 * len(waits))]
    return Report(
        [Table(["Aseba ports; ms", "p50", "p90", "p99", "longest"], rows)],
        [
            Goal("99th percentile of an event and its answer", ALLOWED_MS, p99, "ms"),
            Goal("99th percentile of a request beside a flood", ALLOWED_MS, beside[int(0.99 * len(beside))], "ms"),
            Goal("simulated time per wall time with polls", 0.95, factor, is_least=True),
            Goal("polls that were late", 0.01 * len(polls) / options.robots, late),
        ],
    )


def _quantiles(waits: list[float]) -> list[float]:
    return [statistics.median(waits), waits[int(0.9 * len(waits))], waits[int(0.99 * len(waits))], waits[-1]]
