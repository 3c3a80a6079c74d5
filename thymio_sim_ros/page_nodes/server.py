"""The WebSocket `page-node`, by which a page runs one node at a time, and `page-node.json`: whether it may.

The page sends                        it gets
{"op": "run", "text", "name",         {"op": "ready", "level"}: the program waits for `begin`
 "namespace", "sim_time"}             {"op": "output", "text"}
{"op": "begin"}                       {"op": "ended", "code", "reason", "text"}
{"op": "stop"}

`reason` is "" for a program that has ended by itself or was stopped, else `memory`, `disk`, `isolation` (there is
none), `replaced` (by another page), `refused` (no program), `tooMany` or `lost` (an internal error); `text` says more
in English. The node ends with the connection. A robot has one node: another one replaces it.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import threading
from collections.abc import Callable, Mapping
from typing import Any

from aiohttp import WSMsgType, web

from thymio_sim_ros.access import AccessCheck, RefusedError, Visitor
from thymio_sim_ros.bridge.handshake import select_subprotocol
from thymio_sim_ros.page_nodes.process import ISOLATED, LEVELS, Connect, NodeProcess
from thymio_sim_ros.page_nodes.program import MAX_BYTES, NodeProgram, ProgramRefusedError, program_of
from thymio_sim_ros.page_nodes.same_user import is_same_user
from thymio_sim_ros.page_nodes.who import Right, Who, check_page, right_of
from thymio_sim_ros.web.http_connections import COMMON_HEADERS, start_answer

__all__ = ["NodeServer"]

MAX_NODES = 8
"""Nodes that run at the same time."""
_SUBPROTOCOL = "page-node"
"""What a page offers beside its token, as a browser accepts no connection without one of its sub-protocols."""
_HEARTBEAT_S = 20.0
_CLOSE_S = 1.0
"""Longest time that `close` waits for each node, and for the closing handshake of a page."""
_READ_S = 10.0
"""Longest time without reading after which a page is disconnected: its node waits for it meanwhile."""
_JSON_FACTOR = 6
"""Most bytes of JSON for a byte of a program."""


class NodeServer:
    """Runs the nodes of pages. Only for the thread of the event loop."""

    def __init__(self, access: AccessCheck, who: Who, connect: Connect) -> None:
        """`access`: the check of the bridge."""
        self._access, self._who, self._connect = access, who, connect
        self._running: dict[str, _Page] = {}
        """By namespace of the robot."""

    async def permission(self, request: web.BaseRequest, visitor: Visitor) -> web.StreamResponse:
        """What the visitor may do, for its page."""
        start_answer(request)
        try:
            right = await self._right(request, visitor)
        except RefusedError as error:
            return _json({"right": "", "text": str(error)}, error.status)
        return _json({"right": right.value, "may_run": right.may_run and _is_possible(right)})

    async def handle(self, request: web.BaseRequest, visitor: Visitor) -> web.StreamResponse:
        """Serve a page until it disconnects. Raises RefusedError for one that may not run nodes."""
        check_page(visitor)
        protocol = select_subprotocol(request, (_SUBPROTOCOL,))
        right = await self._right(request, visitor)
        if not right.may_run:
            raise RefusedError(403, f"this visitor may not run nodes: {right.value}; see --nodes in SECURITY.md")
        socket = web.WebSocketResponse(
            heartbeat=_HEARTBEAT_S,
            compress=False,
            max_msg_size=_JSON_FACTOR * MAX_BYTES,
            timeout=_CLOSE_S,
            protocols=() if protocol is None else (protocol,),
        )
        await socket.prepare(request)
        transport = request.transport
        page = _Page(socket, transport.abort if transport is not None else lambda: None)
        try:
            async for message in socket:
                if message.type is not WSMsgType.TEXT or not await self._obey(page, message.data, right):
                    await socket.close(code=1003, message=b"expected JSON with op: run, begin or stop")
        finally:
            self._leave(page)
        return socket

    async def close(self) -> None:
        """End all nodes."""
        processes = [page.process for page in self._running.values() if page.process is not None]
        for process in processes:
            process.end()
        for process in processes:
            await asyncio.to_thread(process.join, _CLOSE_S)

    async def _right(self, request: web.BaseRequest, visitor: Visitor) -> Right:
        role = await self._access.role(visitor)
        transport = request.transport
        if transport is None:
            raise RefusedError(400, "the visitor has left")
        peer, own = transport.get_extra_info("peername"), transport.get_extra_info("sockname")
        return right_of(visitor, role, self._who, is_same_user=is_same_user(peer[:2], own[:2]))

    async def _obey(self, page: _Page, text: str, right: Right) -> bool:
        """Do what a page wants; return whether it was understood."""
        try:
            wanted = json.loads(text)
        except (ValueError, RecursionError):
            return False
        match wanted:
            case {"op": "run", **values}:
                try:
                    await self._run(page, program_of(values), right)
                except ProgramRefusedError as error:
                    await page.send({"op": "ended", "code": None, "reason": "refused", "text": str(error)})
            case {"op": "begin"} if page.process is not None:
                page.process.begin()
            case {"op": "stop"} if page.process is not None:
                page.process.stop()
            case {"op": "begin" | "stop"}:
                pass
            case _:
                return False
        return True

    async def _run(self, page: _Page, program: NodeProgram, right: Right) -> None:
        self._leave(page)
        other = self._running.pop(program.namespace, None)
        if other is not None:
            await other.replace()
        if len(self._running) >= MAX_NODES:
            await page.send({"op": "ended", "code": None, "reason": "tooMany", "text": f"{MAX_NODES} nodes run"})
            return
        self._running[program.namespace] = page
        levels = LEVELS if right is Right.LOCAL else ISOLATED
        page.start(program, levels, self._connect, self._access.rules.tokens.full, self._ended)

    def _leave(self, page: _Page) -> None:
        """End the node of a page."""
        page.end()
        self._ended(page)

    def _ended(self, page: _Page) -> None:
        for namespace in [name for name, other in self._running.items() if other is page]:
            del self._running[namespace]


class _Page:
    """A connected page and its node."""

    def __init__(self, socket: web.WebSocketResponse, abort: Callable[[], object]) -> None:
        """`abort` closes the connection at once."""
        self._socket, self._abort = socket, abort
        self.process: NodeProcess | None = None

    def start(
        self,
        program: NodeProgram,
        levels: tuple[str, ...],
        connect: Connect,
        token: str,
        ended: Callable[[_Page], None],
    ) -> None:
        """Start a node; `ended` is called in this thread when it has ended by itself."""
        loop = asyncio.get_running_loop()

        async def pass_on(process: NodeProcess, event: Mapping[str, Any]) -> None:
            if self.process is not process:
                return
            if event["event"] == "ended":
                self.process = None
                ended(self)
            level = {"level": process.level} if event["event"] == "ready" else {}
            await self.send({"op": event["event"], **{key: event[key] for key in event if key != "event"}, **level})

        def report(event: Mapping[str, Any]) -> None:
            started.wait()
            with contextlib.suppress(RuntimeError, asyncio.CancelledError, TimeoutError):  # the loop has ended
                asyncio.run_coroutine_threadsafe(pass_on(process, event), loop).result()

        started = threading.Event()
        process = self.process = NodeProcess(program, levels, report, connect, token)
        started.set()

    async def replace(self) -> None:
        """End the node, because another page runs one for the same robot."""
        self.end()
        await self.send({"op": "ended", "code": None, "reason": "replaced"})

    def end(self) -> None:
        """End the node if there is one; nothing more is said of it."""
        process, self.process = self.process, None
        if process is not None:
            process.end()

    async def send(self, message: Mapping[str, Any]) -> None:
        """Send a message; wait until the page reads. One that does not read is disconnected."""
        try:
            async with asyncio.timeout(_READ_S):
                await self._socket.send_str(json.dumps(message))
        except TimeoutError:
            self._abort()
        except ConnectionError:
            pass


def _is_possible(right: Right) -> bool:
    return bool(LEVELS if right is Right.LOCAL else ISOLATED)


def _json(value: Mapping[str, Any], status: int = 200) -> web.Response:
    headers = {**COMMON_HEADERS, "Content-Type": "application/json", "Cache-Control": "no-store"}
    return web.Response(status=status, body=json.dumps(value).encode(), headers=headers)
