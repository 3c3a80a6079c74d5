"""The HTTP interface on aiohttp: connections, CORS and server-sent events around a `Gateway`.

All of it runs in one event loop, except that a helper thread compiles programs.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from http import HTTPStatus
from socket import socket

from aiohttp import web

from aseba_vm.protocol.messages import Message
from aseba_vm.protocol.node_client import NodeClient
from thymio_sim_ros.access import NO_PROXIES, AccessCheck, AccessRules, HostNames, RefusedError, Role, Tokens, Visitor
from thymio_sim_ros.access.hosts import is_loopback
from thymio_sim_ros.bridge.listening import listen
from thymio_sim_ros.network.http.cors import cors_headers
from thymio_sim_ros.network.http.gateway import Gateway
from thymio_sim_ros.network.http.programs import compile_file
from thymio_sim_ros.network.http.replies import Definitions, Reply, refusal
from thymio_sim_ros.network.http.requests import (
    METHODS,
    Action,
    LoadProgram,
    StreamEvents,
    parse_request,
)
from thymio_sim_ros.network.hub import Connection, Hub, Network
from thymio_sim_ros.network.settings import OFF, NetworkSettings
from thymio_sim_ros.web.http_connections import COMMON_HEADERS, HttpConnections, Report, start_answer, start_stream

__all__ = ["HttpServer"]

MAX_CONNECTIONS = 128
"""Connections with requests and streams; at this limit, idle ones are closed for new ones."""
NO_TOKENS = Tokens()
MAX_BODY = 1_000_000
"""Bytes of a request's body; a longer one is rejected."""
MAX_QUEUED_EVENTS = 1000
"""Events that wait for a client of a stream; the stream of a client that does not read them is closed."""
MAX_COMPILATIONS = 8
"""Programs that are compiled or wait for it; further ones are rejected."""
_ADVANCE_S, _IDLE_S = 0.1, 0.5
"""Time between two looks at what is due, with requests that wait and without: a class has thirty of these servers."""
_ALLOW = "GET, POST, PUT, OPTIONS"


@dataclass(slots=True)
class _Link:
    """The connection to one network, whose number in the gateway is `index`."""

    index: int
    client: NodeClient
    connection: Connection


class HttpServer:
    """Serves the networks of a hub, as the program asebahttp does. Only for the thread of the event loop."""

    def __init__(self, hub: Hub, settings: NetworkSettings, report: Report, *, tokens: Tokens = NO_TOKENS) -> None:
        """Serve nothing until `start`. `report` takes a kind of problem and its description; clients need `tokens`."""
        self._hub, self._settings, self._report = hub, settings, report
        names = HostNames.LOOPBACK if is_loopback(settings.address) else HostNames.UNOWNED
        self._access = AccessCheck(AccessRules(tokens, names, allowed_origins=settings.allowed_origins), report)
        self._gateway = Gateway()
        self._links: dict[Network, _Link] = {}
        self._loop = asyncio.get_running_loop()
        self._pool = ThreadPoolExecutor(1, "http-compiler")
        self._compilations = 0
        self._connections: HttpConnections
        """Those of its own port."""
        self._ticking: asyncio.Task[None] | None = None
        """Runs while it serves."""
        self._listeners: list[socket] = []
        self.port = OFF
        """The actual port."""

    def start(self) -> None:
        """Serve the networks that are there, and those that come. A port that cannot be opened is reported."""
        settings = self._settings
        try:
            if settings.http_port != OFF:
                self._listeners = listen(settings.address, settings.http_port)
                self.port = int(self._listeners[0].getsockname()[1])
        except (OSError, OverflowError) as error:
            self._report("http", f"HTTP interface: {error}")
            return
        self._gateway.advance(self._now_ns())
        self._hub.follow(self)
        self._connections = HttpConnections(self._answer_on_port, MAX_CONNECTIONS, self._report, self._loop)
        self._connections.accept(self._listeners)
        self._ticking = self._loop.create_task(self._advance_forever())

    async def close(self) -> None:
        """Close port and connections, and leave the networks."""
        if self._ticking is not None:
            self._hub.unfollow(self)
            self._ticking.cancel()
            await asyncio.gather(self._ticking, return_exceptions=True)
            await self._connections.close()
        for network in list(self._links):
            self.network_removed(network)
        for listener in self._listeners:
            listener.close()
        self._pool.shutdown(wait=False, cancel_futures=True)

    def network_added(self, network: Network) -> None:
        """Look for the nodes of a network."""
        client = NodeClient()
        index = self._gateway.add_network(client, network.name)

        def receive(messages: Sequence[Message]) -> None:
            for message in messages:
                self._gateway.receive(index, message)
            self._flush()

        self._links[network] = _Link(index, client, network.connect(receive))
        network.followers.append(self._set_program)
        self._set_program(network)
        client.start(self._now_ns())
        self._flush()

    def network_removed(self, network: Network) -> None:
        """End the requests that wait for a network."""
        network.followers.remove(self._set_program)
        link = self._links.pop(network)
        link.connection.close()
        self._gateway.remove_network(link.index)

    def _set_program(self, network: Network) -> None:
        """Use the names of the program of a robot, whichever tool has loaded it."""
        if network in self._links and (program := network.program) is not None:
            definitions = Definitions(program.events, program.constants)
            self._gateway.set_program(self._links[network].index, program.program, definitions)

    async def _advance_forever(self) -> None:
        while True:
            self._gateway.advance(self._now_ns())
            self._flush()
            await asyncio.sleep(_ADVANCE_S if self._gateway.waiting else _IDLE_S)

    def _now_ns(self) -> int:
        return int(self._loop.time() * 1e9)

    def _flush(self) -> None:
        for link in list(self._links.values()):
            if messages := link.client.pop_messages():
                link.connection.send(*messages)

    async def _answer_on_port(self, request: web.BaseRequest) -> web.StreamResponse:
        """The response to a request on the port of this server, which has no proxies."""
        return await self.answer(request, NO_PROXIES.visitor_of(request))

    async def answer(self, request: web.BaseRequest, visitor: Visitor) -> web.StreamResponse:
        """The response to a request."""
        cors = cors_headers(request.headers, visitor, self._access)
        try:
            self._access.check_page(visitor)
            if request.method == "OPTIONS":
                start_answer(request)
                return _response(Reply(200, b"", "text/plain"), {**cors, "Allow": _ALLOW})
            role = await self._access.role(visitor)
            action = await _action(request)
            if role is not Role.FULL and self._gateway.is_change(action):
                raise RefusedError(403, "this token only reads")
            start_answer(request)
            if isinstance(action, StreamEvents):
                return await self._stream(request, action, cors)
            return _response(await self._carry_out(action), cors)
        except RefusedError as error:
            start_answer(request)
            allow = {"Allow": _ALLOW} if error.status == HTTPStatus.METHOD_NOT_ALLOWED else {}
            response = _response(refusal(error), {**error.headers, **cors, **allow})
            if not request.content.is_eof():  # the rest of a body that is not read
                response.force_close()
            return response

    async def _carry_out(self, action: Action) -> Reply:
        result: asyncio.Future[Reply] = self._loop.create_future()
        self._gateway.advance(self._now_ns())  # its time-outs begin now

        def reply(found: Reply) -> None:
            if not result.done():
                result.set_result(found)

        if isinstance(action, LoadProgram):
            await self._load(action, reply)
        else:
            self._gateway.start(action, reply)
        self._flush()
        return await result

    async def _load(self, action: LoadProgram, reply: Callable[[Reply], None]) -> None:
        nodes = self._gateway.nodes_to_load(action)
        if self._compilations >= MAX_COMPILATIONS:
            raise RefusedError(503, f"{MAX_COMPILATIONS} programs are being compiled already; try again later")
        self._compilations += 1
        try:
            compiled = await self._loop.run_in_executor(self._pool, compile_file, action.text, nodes)
        finally:
            self._compilations -= 1
        for node, program in compiled.programs:
            for link in self._links.values():
                if link.index == node.key[0]:
                    link.connection.remember(program)
        self._gateway.load(compiled, reply)

    async def _stream(
        self, request: web.BaseRequest, action: StreamEvents, cors: Mapping[str, str]
    ) -> web.StreamResponse:
        """Send events until the client leaves, or its number of events is reached."""
        transport = request.transport
        events = _EventQueue(transport.abort if transport is not None else _nothing)
        subscription = self._gateway.subscribe(action, events.put)
        try:
            response = web.StreamResponse(
                headers={**COMMON_HEADERS, **cors, "Content-Type": "text/event-stream", "Cache-Control": "no-cache"}
            )
            response.force_close()  # without a length, the end of the connection is the end of the stream
            start_stream(request)
            await response.prepare(request)
            while batch := await events.get():
                await response.write(batch)
        finally:
            self._gateway.unsubscribe(subscription)
        return response


class _EventQueue:
    """Events of one stream until they are written; `abort` is called if they are too many."""

    def __init__(self, abort: Callable[[], None]) -> None:
        self._abort = abort
        self._lines: deque[bytes] = deque()
        self._is_ended = False
        self._is_ready = asyncio.Event()

    def put(self, line: bytes | None) -> None:
        """Add an event; None is the end."""
        if line is None:
            self._is_ended = True
        elif len(self._lines) < MAX_QUEUED_EVENTS:
            self._lines.append(line)
        else:
            self._abort()
        self._is_ready.set()

    async def get(self) -> bytes:
        """All events that wait, at least one; empty after the last."""
        if not self._lines and not self._is_ended:
            self._is_ready.clear()
            await self._is_ready.wait()
        batch = b"".join(self._lines)
        self._lines.clear()
        return batch


def _nothing() -> None:
    """The connection is closed already."""


async def _action(request: web.BaseRequest) -> Action:
    """The action of a request, after all of its body has arrived."""
    method = request.method
    if method not in METHODS:
        raise RefusedError(405, f"{method[:20]} is not answered; expected {_ALLOW}")
    body = await _body(request) if request.body_exists else b""
    return parse_request(method, request.raw_path, body)


async def _body(request: web.BaseRequest) -> bytes:
    if (request.content_length or 0) > MAX_BODY:
        raise RefusedError(413, f"body of {request.content_length} bytes, expected at most {MAX_BODY}")
    if request.headers.get("Expect", "").lower() == "100-continue":
        await request.writer.write(b"HTTP/1.1 100 Continue\r\n\r\n")
        request.writer.output_size = 0
    chunks = bytearray()
    async for chunk in request.content.iter_any():
        chunks += chunk
        if len(chunks) > MAX_BODY:
            raise RefusedError(413, f"expected a body of at most {MAX_BODY} bytes")
    return bytes(chunks)


def _response(reply: Reply, headers: Mapping[str, str]) -> web.Response:
    common = {**COMMON_HEADERS, "Cache-Control": "no-store", "Content-Type": reply.media_type}
    return web.Response(status=reply.status, body=reply.body, headers={**common, **headers})
