"""The network servers: those that are on, in the thread of page and bridge or in one of their own."""

from __future__ import annotations

import importlib.util
import socket
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Protocol

from thymio_sim_ros.access.tokens import Tokens
from thymio_sim_ros.bridge.report_limiter import ReportLimiter
from thymio_sim_ros.network.announcement import ASEBA, DEVICE_MANAGER, Announcement, Announcer, aseba_properties
from thymio_sim_ros.network.aseba_server import AsebaServer
from thymio_sim_ros.network.http.requests import is_path
from thymio_sim_ros.network.hub import Hub, Network
from thymio_sim_ros.network.settings import HTTP, OFF, TDM, TDM_PATH, NetworkSettings
from thymio_sim_ros.web.thread import ServerThread

if TYPE_CHECKING:
    from thymio_sim_ros.network.tdm_server import TdmServer

__all__ = ["NetworkServers", "Server"]


class Server(Protocol):
    """A server in the thread."""

    def start(self) -> None:
        """Begin to serve."""

    async def close(self) -> None:
        """Close ports and connections."""


class NetworkServers:
    """Runs the servers of a hub. Invariant: hub and servers are used in the thread of their event loop only."""

    def __init__(
        self,
        settings: NetworkSettings,
        *,
        tokens: Tokens | None = None,
        warn: Callable[[str], object],
        info: Callable[[str], object],
        thread: ServerThread | None = None,
    ) -> None:
        """Start the servers. `tokens`: those that clients on other computers need, where the protocol allows it.

        `warn` and `info` take lines for the log, in any thread. `thread`: that of a page, on whose port the servers of
        `NetworkSettings.on_page` are, too; None: a new one.
        """
        self.hub = Hub()
        self._settings, self._warn, self._info = settings, warn, info
        self._tokens = tokens or Tokens()
        self._report = ReportLimiter(warn)
        self._has_page = thread is not None
        self._thread = ServerThread(warn=warn) if thread is None else thread.share()
        self._servers: list[Server] = []
        self._is_closed = False
        self._ports: dict[str, int] = {}
        self._tdm_ports = (OFF, OFF)
        self._announcers: dict[str, Announcer] = {}
        """By address."""
        self.call(self._start)

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
        self._thread.call(function, *arguments)

    def close(self) -> None:
        """Stop the servers, and the thread if it is their own; a second call has no effect."""
        if self._is_closed:
            return
        self._is_closed = True
        self._thread.run(self._close())
        self._thread.close()

    def announce(self, server: str, address: str, announcements: Sequence[Announcement]) -> None:
        """Announce what a server offers at an address, instead of what it offered before; only in this thread."""
        if self._settings.is_announced:
            if address not in self._announcers:
                self._announcers[address] = Announcer(address, self.report)
            self._announcers[address].announce(server, announcements)

    def report(self, about: str, text: str) -> None:
        """Log a warning, at most once a minute for each subject; only in this thread."""
        self._report(about, text)

    def _start(self) -> None:
        self._servers = self._created()
        for server in self._servers:
            server.start()

    async def _close(self) -> None:
        for server in reversed(self._servers):
            await server.close()
        for announcer in self._announcers.values():
            await announcer.close()

    def _created(self) -> list[Server]:
        """Create the servers that are on. A server that is off is not even imported, if its packages take time."""
        settings = self._settings
        servers: list[Server] = []
        if settings.aseba_port != OFF:
            aseba = AsebaServer(self.hub, settings, self.report)
            aseba.ports_changed = lambda: self._set_ports(aseba)
            servers.append(aseba)
        application = self._thread.application if self._has_page else None
        if settings.has_tdm and self._is_installed("Thymio Device Manager", "flatbuffers", "aiohttp"):
            from thymio_sim_ros.network.tdm_server import TdmServer

            tdm = TdmServer(self.hub, settings, self.report, self._opened, password=self._tokens.full)
            if application is not None and TDM in settings.on_page:
                application.websockets[TDM_PATH] = tdm.handle_on_page
            servers.append(tdm)
        if settings.has_http and self._is_installed("HTTP interface", "aiohttp"):
            from thymio_sim_ros.network.http.server import HttpServer

            http = HttpServer(self.hub, settings, self.report, tokens=self._tokens)
            if application is not None and HTTP in settings.on_page:
                application.interfaces.append((is_path, http.answer))
            servers.append(http)
        return servers

    def _is_installed(self, server: str, *packages: str) -> bool:
        missing = [name for name in packages if importlib.util.find_spec(name) is None]
        if missing:
            self.report(server, f"{server}: off, as the package {missing[0]} is not installed")
        return not missing

    def _set_ports(self, server: AsebaServer) -> None:
        self._ports = {network.name: port for port, networks in server.ports.items() for network in networks}
        self.announce("aseba", self._settings.aseba_address, [_aseba(*item) for item in server.ports.items()])

    def _opened(self, server: TdmServer) -> None:
        self._tdm_ports = server.port, server.ws_port
        if server.port == OFF:
            return
        name = f"Thymio Device Manager on {socket.gethostname()}"
        properties = ("uuid", str(server.uuid)), ("ws-port", str(server.ws_port))
        self.announce("tdm", self._settings.address, [Announcement(DEVICE_MANAGER, name, server.port, properties)])


def _aseba(port: int, networks: Sequence[Network]) -> Announcement:
    robot = networks[0].name if len(networks) == 1 else ""
    nodes = [node for network in networks for node in network.node_ids]
    name = f"{robot or 'Thymio'} on {socket.gethostname()}"
    return Announcement(ASEBA, name, port, aseba_properties(nodes))
