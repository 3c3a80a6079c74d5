"""The page's server under attack: what a page load costs meanwhile, and what the server takes, as a table.

python benchmarks/page_server.py

The server is the executable `web_ui` in a process of its own, with the usual limit of 1024 open files. Attackers
connect from 127.0.0.2, the page is loaded from 127.0.0.1 and from the address of the attackers. Linux only.
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

ATTACKER, VISITOR = "127.0.0.2", "127.0.0.1"
DEADLINE_S = 30.0
_ASSET = re.compile(rb'(?:src|href)="\./([^"]+)"')
_HELD_S = 12.0
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


async def attack(server: Server, name: str, count: int, begin: bytes, *, is_read: bool = True) -> None:
    """Hold connections, load the page meanwhile, and print a row."""
    async with held(server.port, count, begin, is_read=is_read):
        own, same = await load(server.port, VISITOR), await load(server.port, ATTACKER)
        cost = server.cost
        await asyncio.sleep(_HELD_S)
        later = server.cost
    row(name, f"{_said(own)}, same address {_said(same)}", cost, later)


async def many_browsers(server: Server, count: int) -> None:
    """So many page loads at once."""
    begin = time.perf_counter()
    loads = await asyncio.gather(*(load(server.port, VISITOR) for _ in range(count)))
    whole = sum(one.is_whole for one in loads)
    row(f"{count} page loads at once", f"{whole} whole in {time.perf_counter() - begin:.2f} s", server.cost)


def _said(one: Load) -> str:
    return f"{one.seconds * 1000:.0f} ms" if one.is_whole else f"NOT SERVED ({one.seconds:.0f} s)"


def row(name: str, result: str, *costs: tuple[int, int, int, int]) -> None:
    """Print a line of the table."""
    reported = " → ".join("/".join(str(value) for value in cost) for cost in costs)
    print(f"| {name} | {result} | {reported} |", flush=True)


async def measure(server: Server, page: str) -> None:
    """All attacks, one after the other."""
    end = time.monotonic() + DEADLINE_S
    while not (await load(server.port, VISITOR)).is_whole:
        if time.monotonic() > end:
            raise SystemExit("the server does not answer; is the page built?")
        await asyncio.sleep(0.2)
    print("| attack | page load | threads/files/MB/bytes of log, at once → 12 s later |\n|---|---|---|")
    row("none", _said(await load(server.port, VISITOR)), server.cost)
    await many_browsers(server, 30)
    await many_browsers(server, 180)
    await attack(server, "300 half requests", 300, b"GET / HTTP/1.1\r\nHost: localhost\r\n")
    await attack(server, "1000 silent connections", 1000, b"")
    whole = f"GET {page} HTTP/1.1\r\nHost: localhost\r\n\r\n".encode()
    await attack(server, "600 that ask and do not read", 600, whole * 8, is_read=False)
    slow = b"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000000\r\n\r\nx"
    await attack(server, "300 slow bodies", 300, slow)
    await attack(server, "300 that pipeline", 300, whole * 300)
    row("none, afterwards", _said(await load(server.port, VISITOR)), server.cost)


@contextlib.contextmanager
def running(port: int) -> Iterator[Server]:
    """A server, ended afterwards."""
    with tempfile.TemporaryDirectory() as folder:
        server = Server(port, Path(folder, "log"))
        try:
            yield server
        finally:
            server.end()


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--port", type=int, default=9245)
    port = parser.parse_args().port
    _, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
    from thymio_sim_ros import resources

    folder = resources.page()
    if folder is None:
        raise SystemExit(resources.PAGE_BUILD_HINT)
    largest = max((folder / "assets").iterdir(), key=lambda path: path.stat().st_size)
    with running(port) as server:
        asyncio.run(measure(server, f"/assets/{largest.name}"))


if __name__ == "__main__":
    main()
