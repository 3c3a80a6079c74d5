"""Addresses and URLs under which this computer and others reach the page and the bridge."""

from __future__ import annotations

import ipaddress
import socket

from thymio_sim_ros.access.hosts import is_loopback
from thymio_sim_ros.access.tokens import Tokens

__all__ = ["describe_access", "describe_urls", "loopback_problem", "own_address", "urls"]

_UNUSED_ADDRESS = ("192.0.2.1", 9)
"""An address of a network reserved for documentation (RFC 5737). A UDP socket that is connected to it sends nothing."""
_LOCALHOST = ("127.0.0.1", "::1")


def own_address() -> str:
    """IPv4 address by which other computers reach this one, or its host name if it has no network."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(_UNUSED_ADDRESS)
        except OSError:
            return socket.gethostname()
        return str(probe.getsockname()[0])


def loopback_problem() -> str:
    """Why programs of this computer cannot reach each other, as the system says it; empty if they can."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect((_LOCALHOST[0], 9))  # sends nothing
        except OSError as error:
            return error.strerror or str(error)
    return ""


def urls(scheme: str, address: str, port: int, path: str = "", token: str = "") -> list[str]:
    """URLs of a server that listens on `address`, a host name or an IP address.

    For all addresses of this computer (`0.0.0.0`, `::`) the URL for this computer comes first, then that for others.
    A token is in the query of a WebSocket URL; in that of a page it is the fragment, which browsers send to no server.
    """
    suffix = "" if not token else f"?token={token}" if scheme.startswith("ws") else f"#token={token}"
    hosts = [address]
    try:
        number = ipaddress.ip_address(address)
    except ValueError:
        pass  # a host name
    else:
        if address in _LOCALHOST:
            hosts = ["localhost"]
        elif number.is_unspecified:
            hosts = ["localhost", own_address()]
        elif number.version == 6:
            hosts = [f"[{address}]"]
    return [f"{scheme}://{host}:{port}{path}{suffix}" for host in hosts]


def describe_urls(scheme: str, address: str, port: int, path: str = "", token: str = "") -> str:
    """The same URLs as text for the user."""
    return ", from other computers ".join(urls(scheme, address, port, path, token))


def describe_access(address: str, tokens: Tokens, *, is_proxied: bool = False) -> str:
    """One line on the computers that reach a server, perhaps by a proxy, and what they may do."""
    if is_loopback(address) and not is_proxied:
        return f"this computer only{', with the token' if tokens.is_required else ''}"
    everyone = "everyone who reaches the proxy" if is_proxied else "everyone in your network"
    if not tokens.is_required:
        return f"{everyone}, without a token: drive, program, load, add robots"
    everything = f"{everyone} with a full address: drive, program, load, add robots"
    return f"{everything}; with a read-only address: watch"
