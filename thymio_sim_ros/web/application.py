"""What all ports of a process answer: WebSockets by their path, interfaces by theirs, the page everything else.

Servers join and leave at any time, because the nodes of a suite start one after the other.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import TYPE_CHECKING

from thymio_sim_ros.access import NO_PROXIES, RefusedError, Visitor
from thymio_sim_ros.web.http_connections import start_answer, text_response

if TYPE_CHECKING:
    from aiohttp import web

    Handler = Callable[[web.BaseRequest, Visitor], Awaitable[web.StreamResponse]]

__all__ = ["Application"]


class Application:
    """Passes requests on. Only for the thread of the event loop."""

    def __init__(self) -> None:
        self.trusted_proxies = NO_PROXIES
        """The proxies in front of the ports."""
        self.websockets: dict[str, Handler] = {}
        """Servers of WebSockets by path. They raise RefusedError for an invalid handshake."""
        self.interfaces: list[tuple[Callable[[str], bool], Handler]] = []
        """Servers of other requests, each with a function that knows its paths."""
        self.page: Handler | None = None
        """The server of all other requests."""

    async def answer(self, request: web.BaseRequest) -> web.StreamResponse:
        """The response to a request."""
        visitor = self.trusted_proxies.visitor_of(request)
        path = request.raw_path.partition("?")[0]
        is_websocket = request.headers.get("Upgrade", "").lower() == "websocket"
        if not is_websocket:
            for is_path, handler in self.interfaces:
                if is_path(path):
                    return await handler(request, visitor)
            if self.page is not None:
                return await self.page(request, visitor)
        start_answer(request)
        if not is_websocket:
            return text_response(426, "There is no page here, only WebSockets: ws://…", {"Upgrade": "websocket"})
        if path not in self.websockets:
            known = " or ".join(self.websockets) or "none"
            return text_response(404, f"There is no WebSocket at this path; expected {known}.")
        try:
            return await self.websockets[path](request, visitor)
        except RefusedError as error:
            return text_response(error.status, str(error), error.headers)
