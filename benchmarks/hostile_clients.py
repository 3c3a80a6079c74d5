"""A suite under attack: the longest time that a quiet client and a page wait, and a class that opens the page at once.

Processes flood the port of a suite in different ways, one after the other. Meanwhile a client connects and asks for a
parameter, ten times per second, and another one opens the page, by a new connection each time; the figures are their
longest times.
Then 180 clients open the page at the same time, each with six connections, and read all that it loads at first. They
are more than the server has places for; a request on a connection that the server has closed to make room is repeated
by a new one, as browsers do.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import re
import subprocess
import sys
import time

import aiohttp
from websockets.asyncio.client import connect

from benchmarks.lib.attacks import ATTACKS
from benchmarks.lib.command import MissingError
from benchmarks.lib.processes import suite
from benchmarks.lib.report import ROOT, Cell, Goal, Report, Table
from thymio_sim_ros.bridge.protocol.constants import SUBPROTOCOLS
from thymio_sim_ros.files import resources

QUICK = {"seconds": 0.5, "loads": 3, "attacks": ["pings and empty frames, 8 clients"]}
MOST_MS = 500
LOADS = 180
CONNECTIONS = 6
_PERIOD_S = 0.1
_WARM_UP_S = 1.0
_DEADLINE_S = 60.0
_ASK = json.dumps({"op": "getParameters", "parameterNames": ["/simulator.playground"], "id": "quiet"})
_FILE = re.compile(r'(?:src|href)="\./([^"]+)"')


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--seconds", type=float, default=8.0, help="seconds of each attack")
    parser.add_argument("--attacks", nargs="+", choices=list(ATTACKS), default=list(ATTACKS), help="attacks")
    parser.add_argument("--loads", type=int, default=LOADS, help="clients that open the page at once")


def measure(options: argparse.Namespace) -> Report:
    """Attack one suite in all ways."""
    if resources.page() is None:
        raise MissingError("file", "web_ui/dist/index.html")
    rows: list[list[Cell]] = []
    with suite("--portable", "--program", "explorer") as running:
        port = running.page_port
        rows.append(["none", *asyncio.run(quiet(port, options.seconds))])
        for name in options.attacks:
            attack = subprocess.Popen([sys.executable, "-m", "benchmarks.lib.attacks", name, str(port)], cwd=ROOT)
            try:
                time.sleep(_WARM_UP_S)
                assert attack.poll() is None, f"the attack has ended: {name}"
                rows.append([name, *asyncio.run(quiet(port, options.seconds))])
            finally:
                attack.kill()
                attack.wait()
            time.sleep(_WARM_UP_S)
        whole, passed_s = asyncio.run(opened(port, options.loads))
    worst = max(max(row[1:]) for row in rows[1:])
    goals = [
        Goal("longest wait beside hostile clients", MOST_MS, round(worst), "ms"),
        Goal(f"{options.loads} pages at once, not whole", 0, options.loads - whole),
    ]
    head = ["attack", "longest connection or request of a parameter, ms", "longest load of the page, ms"]
    loads = Table(["pages opened at once", "whole", "s"], [[options.loads, whole, passed_s]])
    return Report([Table(head, rows), loads], goals)


async def quiet(port: int, seconds: float) -> tuple[float, float]:
    """The longest times of a request by an open WebSocket, and of the page by a new connection, ms."""
    end_s = time.monotonic() + seconds
    asked, loaded = await asyncio.gather(_asking(port, end_s), _loading(port, end_s))
    return asked, loaded


async def _asking(port: int, end_s: float) -> float:
    began_s = time.monotonic()
    address = f"ws://127.0.0.1:{port}/"
    how = {"subprotocols": SUBPROTOCOLS, "max_size": None, "proxy": None, "open_timeout": _DEADLINE_S}
    async with connect(address, **how) as client:  # type: ignore[arg-type]
        longest_s = time.monotonic() - began_s
        while (began_s := time.monotonic()) < end_s:
            await client.send(_ASK)
            while '"quiet"' not in str(await asyncio.wait_for(client.recv(), _DEADLINE_S)):
                pass
            longest_s = max(longest_s, time.monotonic() - began_s)
            await asyncio.sleep(_PERIOD_S)
    return 1000 * longest_s


async def _loading(port: int, end_s: float) -> float:
    longest_s = 0.0
    while (began_s := time.monotonic()) < end_s:
        async with aiohttp.ClientSession(timeout=aiohttp.ClientTimeout(_DEADLINE_S)) as session:
            await _read(session, f"http://127.0.0.1:{port}/")
        longest_s = max(longest_s, time.monotonic() - began_s)
        await asyncio.sleep(_PERIOD_S)
    return 1000 * longest_s


async def _read(session: aiohttp.ClientSession, address: str) -> bytes:
    async with session.get(address) as answer:
        body = await answer.read()
        assert answer.status == 200, f"{address}: {answer.status}"
        return body


async def opened(port: int, count: int) -> tuple[int, float]:
    """Open the page at the same time; return how many clients have got all of it, and the time of the last one, s."""
    began_s = time.monotonic()
    results = await asyncio.gather(*(_open(port) for _ in range(count)), return_exceptions=True)
    return sum(result is None for result in results), time.monotonic() - began_s


async def _read_again(session: aiohttp.ClientSession, address: str) -> bytes:
    try:
        return await _read(session, address)
    except aiohttp.ServerDisconnectedError:
        async with aiohttp.ClientSession(timeout=session.timeout) as fresh:
            return await _read(fresh, address)


async def _open(port: int) -> None:
    address = f"http://127.0.0.1:{port}/"
    connector = aiohttp.TCPConnector(limit=CONNECTIONS)
    timeout = aiohttp.ClientTimeout(_DEADLINE_S)
    async with aiohttp.ClientSession(connector=connector, timeout=timeout) as session:
        page = (await _read_again(session, address)).decode()
        files = sorted({file for file in _FILE.findall(page) if not file.startswith("#")})
        await asyncio.gather(*(_read_again(session, address + file) for file in [*files, "config.json"]))
