"""The thread of the network servers, with its event loop."""

from __future__ import annotations

import asyncio
import contextlib
import importlib.util
import socket
import threading
import traceback
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Protocol

from thymio_sim_ros.bridge.access import Tokens
from thymio_sim_ros.bridge.report_limiter import ReportLimiter
from thymio_sim_ros.network.announcement import ASEBA, DEVICE_MANAGER, Announcement, Announcer, aseba_properties
from thymio_sim_ros.network.aseba_server import AsebaServer
from thymio_sim_ros.network.hub import Hub, Network
from thymio_sim_ros.network.settings import OFF, NetworkSettings

if TYPE_CHECKING:
    from thymio_sim_ros.network.tdm_server import TdmServer

__all__ = ["NetworkThread", "Server"]

_CLOSE_TIMEOUT_S = 3.0
"""Longest time that `close` waits; the thread is a daemon."""


class Server(Protocol):
    """A server in the thread."""

    def start(self) -> None:
        """Begin to serve."""

    async def close(self) -> None:
        """Close ports and connections."""


class NetworkThread:
    """Runs the servers of a hub. Invariant: hub and servers are used in this thread only."""

    def __init__(
        self,
        settings: NetworkSettings,
        *,
        tokens: Tokens | None = None,
        warn: Callable[[str], object],
        info: Callable[[str], object],
    ) -> None:
        """Start the thread. `tokens`: those that clients on other computers need, where the protocol allows it.

        `warn` and `info` take lines for the log, in any thread.
        """
        self.hub = Hub()
        self._settings, self._warn, self._info = settings, warn, info
        self._tokens = tokens or Tokens()
        self._report = ReportLimiter(warn)
        self._loop = asyncio.SelectorEventLoop()  # as `ServerThread`
        self._stop = asyncio.Event()
        self._thread = threading.Thread(target=self._run, name="network-servers", daemon=True)
        self._is_closed = False
        self._ports: dict[str, int] = {}
        self._tdm_ports = (OFF, OFF)
        self._announcers: dict[str, Announcer] = {}
        """By address."""
        self._thread.start()

    @property
    def ports(self) -> dict[str, int]:
        """Aseba port of each robot by name; from any thread."""
        return dict(self._ports)

    @property
    def tdm_ports(self) -> tuple[int, int]:
        """TCP and WebSocket port of the Thymio Device Manager, `OFF` if it does not run; from any thread."""
        return self._tdm_ports

    def call(self, function: Callable[..., object], *arguments: Any) -> None:
        """Call a function in the thread; from any thread. Does nothing once the thread has ended."""
        with contextlib.suppress(RuntimeError):
            self._loop.call_soon_threadsafe(function, *arguments)

    def close(self) -> None:
        """Stop the servers and the thread; a second call has no effect."""
        if self._is_closed:
            return
        self._is_closed = True
        self.call(self._stop.set)
        self._thread.join(_CLOSE_TIMEOUT_S)

    def announce(self, server: str, address: str, announcements: Sequence[Announcement]) -> None:
        """Announce what a server offers at an address, instead of what it offered before; only in this thread."""
        if self._settings.is_announced:
            if address not in self._announcers:
                self._announcers[address] = Announcer(address, self.report)
            self._announcers[address].announce(server, announcements)

    def report(self, about: str, text: str) -> None:
        """Log a warning, at most once a minute for each subject; only in this thread."""
        self._report(about, text)

    def _run(self) -> None:
        try:
            self._loop.run_until_complete(self._serve())
        except Exception:
            self._warn(f"the network servers have ended, internal error (please report):\n{traceback.format_exc()}")
        finally:
            self._loop.run_until_complete(self._loop.shutdown_asyncgens())
            self._loop.close()

    async def _serve(self) -> None:
        self._loop.set_exception_handler(lambda _loop, context: self.report(*_described(context)))
        servers = self._servers()
        for server in servers:
            server.start()
        await self._stop.wait()
        for server in reversed(servers):
            await server.close()
        for announcer in self._announcers.values():
            await announcer.close()
        others = asyncio.all_tasks() - {asyncio.current_task()}
        for task in others:
            task.cancel()
        await asyncio.gather(*others, return_exceptions=True)

    def _servers(self) -> list[Server]:
        """Create the servers that are on. A server that is off is not even imported, if its packages take time."""
        settings = self._settings
        servers: list[Server] = []
        if settings.aseba_port != OFF:
            aseba = AsebaServer(self.hub, settings, self.report)
            aseba.ports_changed = lambda: self._set_ports(aseba)
            servers.append(aseba)
        if settings.tdm_port != OFF:
            missing = [name for name in ("flatbuffers", "aiohttp") if importlib.util.find_spec(name) is None]
            if missing:
                self.report("tdm", f"Thymio Device Manager: off, as the package {missing[0]} is not installed")
            else:
                from thymio_sim_ros.network.tdm_server import TdmServer

                servers.append(TdmServer(self.hub, settings, self.report, self._opened, password=self._tokens.full))
        if settings.http_port != OFF:
            if importlib.util.find_spec("aiohttp") is None:
                self.report("http", "HTTP interface: off, as the package aiohttp is not installed")
            else:
                from thymio_sim_ros.network.http.server import HttpServer

                servers.append(HttpServer(self.hub, settings, self.report, tokens=self._tokens))
        return servers

    def _set_ports(self, server: AsebaServer) -> None:
        self._ports = {network.name: port for port, networks in server.ports.items() for network in networks}
        self.announce("aseba", self._settings.aseba_address, [_aseba(*item) for item in server.ports.items()])

    def _opened(self, server: TdmServer) -> None:
        self._tdm_ports = server.port, server.ws_port
        name = f"Thymio Device Manager on {socket.gethostname()}"
        properties = ("uuid", str(server.uuid)), ("ws-port", str(server.ws_port))
        self.announce("tdm", self._settings.address, [Announcement(DEVICE_MANAGER, name, server.port, properties)])


def _aseba(port: int, networks: Sequence[Network]) -> Announcement:
    robot = networks[0].name if len(networks) == 1 else ""
    nodes = [node for network in networks for node in network.node_ids]
    name = f"{robot or 'Thymio'} on {socket.gethostname()}"
    return Announcement(ASEBA, name, port, aseba_properties(nodes))


def _described(context: dict[str, Any]) -> tuple[str, str]:
    """Subject and text of a warning about an exception in a callback of the loop."""
    error = context.get("exception")
    text = "".join(traceback.format_exception(error)) if error is not None else ""
    message = context.get("message", "a connection failed")
    return type(error).__name__, f"network servers: {message}, internal error (please report):\n{text}"
