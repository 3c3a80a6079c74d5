"""Settings of the network servers: protocols, addresses and ports."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["ASEBA_PORT", "HTTP_PORT", "LAST_PORT", "OFF", "TDM_PORT", "TDM_WS_PORT", "NetworkSettings"]

ASEBA_PORT = 33333
"""The port of the first robot, as in all Aseba tools."""

TDM_PORT, TDM_WS_PORT = 8596, 8597
"""The ports where clients look for a Thymio Device Manager: TCP and WebSocket."""

HTTP_PORT = 3000
"""The port of asebahttp."""

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
    allowed_origins: tuple[str, ...] = ()
    is_announced: bool = True

    @property
    def is_off(self) -> bool:
        """Whether nothing is served."""
        return {self.aseba_port, self.tdm_port, self.http_port} == {OFF}
