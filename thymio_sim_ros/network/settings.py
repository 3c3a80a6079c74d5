"""Settings of the network servers: protocols, addresses and ports."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = [
    "ASEBA_PORT",
    "HTTP",
    "HTTP_PORT",
    "LAST_PORT",
    "OFF",
    "TDM",
    "TDM_PATH",
    "TDM_PORT",
    "TDM_WS_PORT",
    "NetworkSettings",
]

ASEBA_PORT = 33333
"""The port of the first robot, as in all Aseba tools."""

TDM_PORT, TDM_WS_PORT = 8596, 8597
"""The ports where clients look for a Thymio Device Manager: TCP and WebSocket."""

HTTP_PORT = 3000
"""The port of asebahttp."""

TDM, HTTP = "tdm", "http"
"""Servers that can be on the port of a page."""

TDM_PATH = "/tdm"
"""The path of the Thymio Device Manager's WebSocket on the port of a page."""

LAST_PORT = 65535

OFF = -1
"""Instead of a port: the server does not run."""


@dataclass(frozen=True, slots=True)
class NetworkSettings:
    """Ports of the servers; `OFF` for none, 0 for a free one.

    Attributes:
        aseba_port: Aseba port of the first robot; further robots have the next ports.
        aseba_address: address on which the Aseba ports listen. The protocol has no token: every program that reaches
            this address controls the robots.
        is_aseba_shared: whether all robots are on one Aseba port.
        address: address on which servers with a token or password listen.
        tdm_port: TCP port of the Thymio Device Manager; `OFF` also for its WebSocket port.
        tdm_ws_port: WebSocket port of the Thymio Device Manager.
        http_port: port of the HTTP interface.
        on_page: servers, `TDM` and `HTTP`, that are also on the port of a page in the same process.
        allowed_origins: additional origins of web pages that may connect; `*` allows all.
        is_announced: whether services are announced by mDNS.
    """

    aseba_port: int = OFF
    aseba_address: str = "localhost"
    is_aseba_shared: bool = False
    address: str = "localhost"
    tdm_port: int = OFF
    tdm_ws_port: int = TDM_WS_PORT
    http_port: int = OFF
    on_page: tuple[str, ...] = ()
    allowed_origins: tuple[str, ...] = ()
    is_announced: bool = True

    @property
    def is_off(self) -> bool:
        """Whether nothing is served."""
        return self.aseba_port == OFF and not self.has_tdm and not self.has_http

    @property
    def has_tdm(self) -> bool:
        """Whether there is a Thymio Device Manager."""
        return self.tdm_port != OFF or TDM in self.on_page

    @property
    def has_http(self) -> bool:
        """Whether there is an HTTP interface."""
        return self.http_port != OFF or HTTP in self.on_page
