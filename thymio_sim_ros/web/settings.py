"""Settings of the page's server."""

from __future__ import annotations

import ipaddress
from dataclasses import dataclass

__all__ = ["Settings", "max_connections"]

_MOST_CONNECTIONS = 768
"""Enough for 180 browsers that open the page at once."""


def max_connections() -> int:
    """Connections to have at once: at most three quarters of the files that this process may open."""
    try:
        import resource
    except ImportError:  # not on this platform
        return _MOST_CONNECTIONS
    soft, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
    return _MOST_CONNECTIONS if soft == resource.RLIM_INFINITY else max(8, min(_MOST_CONNECTIONS, soft * 3 // 4))


@dataclass(frozen=True, slots=True)
class Settings:
    """Limits and manners of the page's server.

    `foxglove_port` is the port of the bridge on the same host. `is_loopback`: it listens for this computer only, and is
    then known by no other names than that of a loopback and `allowed_hosts`: a foreign page whose name leads here (DNS
    rebinding) gets nothing.
    """

    foxglove_port: int
    is_loopback: bool = True
    allowed_hosts: tuple[str, ...] = ()
    max_connections: int = _MOST_CONNECTIONS

    def is_allowed_host(self, name: str | None) -> bool:
        """Whether a request may name the server so; None: it says what no name can be."""
        if not self.is_loopback:
            return True
        if name is None:
            return False
        if name == "localhost" or name.endswith(".localhost") or name in self.allowed_hosts:
            return True
        try:
            return ipaddress.ip_address(name).is_loopback
        except ValueError:
            return False
