"""A class whose suites are replaced by a server of the test, and requests to it."""

from __future__ import annotations

import asyncio
import contextlib
import ssl
from collections.abc import AsyncIterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from aiohttp import web

from tests.classroom.test_requests import OPTIONS
from thymio_sim_ros.access.visitor import TrustedProxies
from thymio_sim_ros.bridge.listening import listen
from thymio_sim_ros.classroom import server
from thymio_sim_ros.classroom.address import ClassAddress
from thymio_sim_ros.classroom.classroom import Classroom
from thymio_sim_ros.classroom.folder import ClassFolder

PAGES = ("index", "class", "join")


@dataclass
class ServedClass:
    """A class of Ada and Ben that listens on loopback."""

    place: ClassAddress
    classroom: Classroom

    @property
    def port(self) -> int:
        """The port of the class."""
        return self.place.port

    def url(self, path: str = "") -> str:
        """The URL of a path."""
        return f"{self.place.scheme}://localhost:{self.port}/{path}"


def built_page(path: Path) -> Path:
    """A folder as that of the built page; each page is its own name."""
    folder = path / "page"
    (folder / "assets").mkdir(parents=True)
    for page in PAGES:
        (folder / f"{page}.html").write_text(page)
    (folder / "assets" / "index-DGs6OHeF.js").write_text("export {};")
    return folder


@contextlib.asynccontextmanager
async def served(
    path: Path,
    *,
    teacher_token: str = "",
    proxies: Sequence[str] = (),
    tls: ssl.SSLContext | None = None,
    has_room: bool = True,
) -> AsyncIterator[ServedClass]:
    """Serve a class whose suites are not started."""
    folder = ClassFolder(path / "class")
    folder.teacher_token = teacher_token or folder.teacher_token
    classroom = Classroom(folder.places(["Ada", "Ben"]), OPTIONS, folder)
    listeners = listen("127.0.0.1", 0)
    port = int(listeners[0].getsockname()[1])
    place = ClassAddress("127.0.0.1", port, TrustedProxies(proxies), tls, has_room=has_room)
    serving = asyncio.create_task(server.serve_class(listeners, classroom, built_page(path), place))
    try:
        yield ServedClass(place, classroom)
    finally:
        serving.cancel()
        await asyncio.gather(serving, return_exceptions=True)
        for listener in listeners:
            listener.close()


@dataclass
class FakeSuite:
    """In place of Ada's suite: it notes the requests, and answers in the ways of suites."""

    port: int = 0
    requests: list[web.BaseRequest] = field(default_factory=list)
    go_on: asyncio.Event = field(default_factory=asyncio.Event)
    """Until it is set, the end of a stream and the frames of a flood wait."""
    left: asyncio.Event = field(default_factory=asyncio.Event)
    """Set when a WebSocket has ended."""
    sent: int = 0
    """Bytes of the flood that could be sent."""

    async def answer(self, request: web.BaseRequest) -> web.StreamResponse:
        """The response to a request."""
        self.requests.append(request)
        if request.headers.get("Upgrade") == "websocket":
            return await self._talk(request)
        if request.path == "/events":
            response = web.StreamResponse(headers={"Content-Type": "text/event-stream"})
            await response.prepare(request)
            await response.write(b"data: first\n\n")
            await self.go_on.wait()
            await response.write(b"data: last\n\n")
            return response
        return web.Response(text=f"{request.method} {request.path_qs} {(await request.read()).decode()}")

    async def _talk(self, request: web.BaseRequest) -> web.StreamResponse:
        if request.query.get("token") != "right":
            return web.Response(status=401, text="the token is wrong\n")
        socket = web.WebSocketResponse(protocols=("foxglove.sdk.v1",))
        await socket.prepare(request)
        try:
            await socket.send_str("hello")
            async for message in socket:
                if message.data == "flood":
                    await self._flood(socket)
                else:
                    await socket.send_bytes(message.data)
        finally:
            self.left.set()
        return socket

    async def _flood(self, socket: web.WebSocketResponse) -> None:
        frame = bytes(1 << 16)
        while not self.go_on.is_set():
            await socket.send_bytes(frame)
            self.sent += len(frame)
        await socket.send_str("end")


@contextlib.asynccontextmanager
async def fake_suite(of: ServedClass, pupil: str = "ada") -> AsyncIterator[FakeSuite]:
    """Serve a fake suite on the port of a pupil's."""
    suite = FakeSuite()
    runner = web.ServerRunner(web.Server(suite.answer), shutdown_timeout=0.1)
    await runner.setup()
    site = web.TCPSite(runner, "127.0.0.1", 0)
    await site.start()
    suite.port = of.classroom.seats[pupil].port = runner.addresses[0][1]
    try:
        yield suite
    finally:
        suite.go_on.set()
        await runner.cleanup()
