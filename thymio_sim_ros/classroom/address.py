"""Where a class listens, its URL, and how pupils enter it."""

from __future__ import annotations

import ssl
from dataclasses import dataclass

from thymio_sim_ros.access import NO_PROXIES, TrustedProxies, Visitor
from thymio_sim_ros.access.hosts import host_name, is_loopback, is_loopback_name
from thymio_sim_ros.names.addresses import urls

__all__ = ["ClassAddress"]


@dataclass(frozen=True, slots=True)
class ClassAddress:
    """Where a class listens, the proxies in front of it, and how pupils enter."""

    address: str
    port: int
    trusted_proxies: TrustedProxies = NO_PROXIES
    tls: ssl.SSLContext | None = None
    """The certificate with which the class speaks https; None: http."""
    has_room: bool = True
    """Whether pupils can enter with the code of the room and choose a name, and not only by their links."""

    @property
    def scheme(self) -> str:
        """That of the URL on the port of the class."""
        return "http" if self.tls is None else "https"

    @property
    def is_loopback(self) -> bool:
        """Whether only this computer reaches the class."""
        return is_loopback(self.address) and not self.trusted_proxies

    def public_url(self, visitor: Visitor) -> str:
        """The URL of the class for other computers: as this visitor sees it, unless only its own computer does."""
        is_own = not visitor.is_proxied and is_loopback_name(host_name(visitor.host or ""))
        return urls(self.scheme, self.address, self.port, "/")[-1] if visitor.url is None or is_own else visitor.url
