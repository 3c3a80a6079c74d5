"""The page's server under attack: how long a page load takes meanwhile, and what the server uses.

The server is the executable `web_ui` in a process of its own, with the usual limit of 1024 open files. Attackers
connect from 127.0.0.2, the page is loaded from 127.0.0.1 and from the address of the attackers. Linux only. Needs ROS
and the built page.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import os
import re
import resource
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import AsyncIterator, Iterator
from dataclasses import dataclass
from pathlib import Path

import rclpy  # noqa: F401  # the server needs it

from benchmarks.lib.command import MissingError
from benchmarks.lib.report import Report, Table
from tests.processes import free_port
from thymio_sim_ros.files import resources

QUICK = {"browsers": [3], "held": 0.2}
ATTACKER, VISITOR = "127.0.0.2", "127.0.0.1"
DEADLINE_S = 30.0
_ASSET = re.compile(rb'(?:src|href)="\./([^"]+)"')
_OPEN_FILES = 1024


@dataclass(frozen=True)
class Load:
    """What a page load gave."""

    is_whole: bool
    seconds: float


class Server:
    """The process under attack."""

    def __init__(self, port: int, log: Path) -> None:
        code = "import sys; from thymio_sim_ros.ros.web.node import main; sys.exit(main())"
        arguments = [sys.executable, "-c", code, "--ros-args", "-p", f"port:={port}"]
        self.port, self._log = port, log
        self._process = subprocess.Popen(
            arguments,
            stdout=log.open("wb"),
            stderr=subprocess.STDOUT,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (_OPEN_FILES, _OPEN_FILES)),
        )

    def end(self) -> None:
        """End the process."""
        self._process.terminate()
        self._process.wait(20)

    @property
    def cost(self) -> tuple[int, int, int, int]:
        """Threads, open files, resident memory in MB, bytes of log."""
        proc = Path("/proc", str(self._process.pid))
        status = dict(line.split(":", 1) for line in (proc / "status").read_text().splitlines())
        memory_mb = int(status["VmRSS"].split()[0]) // 1024
        return int(status["Threads"]), len(os.listdir(proc / "fd")), memory_mb, self._log.stat().st_size


async def get(port: int, path: str, source: str) -> bytes:
    """Status line and headers, an empty line, and the body; on a connection of its own."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port, local_addr=(source, 0))
    try:
        writer.write(f"GET {path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n".encode())
        return await reader.read(-1)
    finally:
        writer.close()


async def load(port: int, source: str) -> Load:
    """Load the page as a browser does: the document, then all that it names, each on a connection of its own."""
    begin = time.perf_counter()
    try:
        async with asyncio.timeout(DEADLINE_S):
            page = await get(port, "/", source)
            paths = ["/config.json", *(f"/{name.decode()}" for name in _ASSET.findall(page))]
            answers = [page, *await asyncio.gather(*(get(port, path, source) for path in paths))]
            is_whole = len(answers) > 2 and all(_is_whole(answer) for answer in answers)
    except (OSError, TimeoutError):
        is_whole = False
    return Load(is_whole, time.perf_counter() - begin)


def _is_whole(answer: bytes) -> bool:
    head, _, body = answer.partition(b"\r\n\r\n")
    length = re.search(rb"(?i)content-length: (\d+)", head)
    return b" 200 " in head.partition(b"\r\n")[0] and length is not None and len(body) == int(length[1])


@contextlib.asynccontextmanager
async def held(port: int, count: int, begin: bytes, *, is_read: bool = True) -> AsyncIterator[None]:
    """So many connections of an attacker that have sent this and do nothing more."""
    loop = asyncio.get_running_loop()
    sockets = []
    for _ in range(count):
        one = socket.socket()
        one.setblocking(False)
        if not is_read:
            one.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        one.bind((ATTACKER, 0))
        with contextlib.suppress(OSError, TimeoutError):
            await asyncio.wait_for(loop.sock_connect(one, ("127.0.0.1", port)), 2.0)
            if begin:
                await loop.sock_sendall(one, begin)
        sockets.append(one)
    try:
        yield
    finally:
        for one in sockets:
            one.close()


Row = list[str | float | None]


async def attack(server: Server, name: str, count: int, begin: bytes, held_s: float, *, is_read: bool = True) -> Row:
    """Hold connections and load the page meanwhile; return a row."""
    async with held(server.port, count, begin, is_read=is_read):
        own, same = await load(server.port, VISITOR), await load(server.port, ATTACKER)
        cost = server.cost
        await asyncio.sleep(held_s)
        later = server.cost
    return [name, _ms(own), _ms(same), _cost(cost), _cost(later)]


async def many_browsers(server: Server, count: int) -> Row:
    """Load the page so many times at once; return a row."""
    begin = time.perf_counter()
    loads = await asyncio.gather(*(load(server.port, VISITOR) for _ in range(count)))
    whole = sum(one.is_whole for one in loads)
    if whole < count:
        return [f"{count} page loads at once: only {whole} are whole", None, None, _cost(server.cost), None]
    return [f"{count} page loads at once", 1000 * (time.perf_counter() - begin), None, _cost(server.cost), None]


def _ms(one: Load) -> float | str:
    return one.seconds * 1000 if one.is_whole else "not served"


def _cost(cost: tuple[int, int, int, int]) -> str:
    return " / ".join(str(value) for value in cost)


async def run(server: Server, page: str, options: argparse.Namespace) -> list[Row]:
    """Run all attacks, one after the other."""
    end = time.monotonic() + DEADLINE_S
    while not (await load(server.port, VISITOR)).is_whole:
        if time.monotonic() > end:
            raise RuntimeError("the server does not answer")
        await asyncio.sleep(0.2)
    rows: list[Row] = [["nothing", _ms(await load(server.port, VISITOR)), None, _cost(server.cost), None]]
    rows += [await many_browsers(server, count) for count in options.browsers]
    whole = f"GET {page} HTTP/1.1\r\nHost: localhost\r\n\r\n".encode()
    slow = b"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000000\r\n\r\nx"
    attacks = {
        "300 half requests": (300, b"GET / HTTP/1.1\r\nHost: localhost\r\n", True),
        "1000 silent connections": (1000, b"", True),
        "600 clients that request and do not read": (600, whole * 8, False),
        "300 slow bodies": (300, slow, True),
        "300 pipelining clients": (300, whole * 300, True),
    }
    for name, (count, begin, is_read) in attacks.items():
        if options.only in name:
            rows.append(await attack(server, name, count, begin, options.held, is_read=is_read))
    return [*rows, ["nothing, afterwards", _ms(await load(server.port, VISITOR)), None, _cost(server.cost), None]]


@contextlib.contextmanager
def running(port: int) -> Iterator[Server]:
    """A server, ended afterwards."""
    with tempfile.TemporaryDirectory() as folder:
        server = Server(port, Path(folder, "log"))
        try:
            yield server
        finally:
            server.end()


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--only", default="", metavar="WORDS", help="attacks with this in their names")
    parser.add_argument("--browsers", type=int, nargs="+", default=[30, 180], help="page loads at once")
    parser.add_argument("--held", type=float, default=12.0, help="seconds that connections are held")


def measure(options: argparse.Namespace) -> Report:
    """Run all attacks on one server."""
    folder = resources.page()
    if folder is None:
        raise MissingError("file", "web_ui/dist/index.html")
    _, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
    largest = max((folder / "assets").iterdir(), key=lambda path: path.stat().st_size)
    with running(free_port()) as server:
        rows = asyncio.run(run(server, f"/assets/{largest.name}", options))
    title = "The server: threads / open files / MB / bytes of log, at once and when the connections have been held"
    return Report([Table(["attack", "page load, ms", "same address", "server", "later"], rows, title)])
