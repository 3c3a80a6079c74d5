"""What the network servers serve, and where."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["ASEBA_PORT", "OFF", "NetworkSettings"]

ASEBA_PORT = 33333
"""The port of the first robot, as in all Aseba tools."""

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
        is_announced: whether services are announced by mDNS.
    """

    aseba_port: int = OFF
    aseba_address: str = "localhost"
    is_aseba_shared: bool = False
    is_announced: bool = True

    @property
    def is_off(self) -> bool:
        """Whether nothing is served."""
        return self.aseba_port == OFF
