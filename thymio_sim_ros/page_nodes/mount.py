"""Puts the nodes of pages on the ports of a process; a visit that runs none imports nothing of it."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from thymio_sim_ros.access import AccessCheck, Visitor
from thymio_sim_ros.page_nodes.who import Who
from thymio_sim_ros.web import ServerThread

if TYPE_CHECKING:
    from aiohttp import web

    from thymio_sim_ros.page_nodes.server import NodeServer

__all__ = ["PERMISSION_PATH", "SOCKET_PATH", "mount"]

SOCKET_PATH, PERMISSION_PATH = "/page-node", "/page-node.json"
"""The WebSocket of a page, and what it may do."""


def mount(thread: ServerThread, access: AccessCheck, who: Who) -> None:
    """Run the nodes of pages in the thread of all servers. `access`: the check of the bridge."""

    # Nodes have connections of their own: without TLS, as they do not know the name in the certificate, and without
    # time limits, because a node has its connection before its interpreter has started.
    port = cache(thread.listen_for_own)

    @cache
    def server() -> NodeServer:
        from thymio_sim_ros.page_nodes.process import ISOLATED
        from thymio_sim_ros.page_nodes.server import NodeServer

        nodes = NodeServer(access, who, thread.connect_own if ISOLATED else port)
        thread.at_close(nodes.close)
        return nodes

    async def permission(request: web.BaseRequest, visitor: Visitor) -> web.StreamResponse:
        return await server().permission(request, visitor)

    async def socket(request: web.BaseRequest, visitor: Visitor) -> web.StreamResponse:
        return await server().handle(request, visitor)

    def begin() -> None:
        thread.application.websockets[SOCKET_PATH] = socket
        thread.application.interfaces.append((PERMISSION_PATH.__eq__, permission))

    thread.call(begin)
