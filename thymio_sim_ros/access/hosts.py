"""Names and addresses of servers: which of them reach this computer only, and which a foreign page may own.

A foreign page whose name resolves to this computer (DNS rebinding) is, for the browser, a page of this server.
Therefore a server must not answer requests for a name that others may own.
"""

from __future__ import annotations

import ipaddress
import re
from collections.abc import Collection

__all__ = ["HOST", "host_name", "is_loopback", "is_loopback_name", "is_numeric", "is_private_name"]

HOST = re.compile(r"(?P<name>[A-Za-z0-9_.-]{1,253}|\[[0-9A-Fa-f:.]{2,45}\])(?::\d{1,5})?")
"""Form of a Host header."""


def host_name(host: str) -> str | None:
    """The name or address in a Host header, without brackets and port; None if it is invalid."""
    match = HOST.fullmatch(host)
    return None if match is None else match["name"].strip("[]").lower()


def is_loopback(address: str) -> bool:
    """Whether an address to listen on is reachable only from this computer."""
    if address == "localhost":
        return True
    try:
        return ipaddress.ip_address(address).is_loopback
    except ValueError:
        return False


def is_loopback_name(name: str | None, allowed: Collection[str] = ()) -> bool:
    """Whether a request may address a server on loopback by this name; None: the name of the request is invalid."""
    if name is None:
        return False
    return name.endswith(".localhost") or name in allowed or is_loopback(name)


def is_numeric(host: str) -> bool:
    """Whether a host is a numeric address."""
    try:
        ipaddress.ip_address(host)
    except ValueError:
        return False
    return True


def is_private_name(name: str) -> bool:
    """Whether no foreign page can have this name: it is known in the local network only."""
    return "." not in name or name.endswith(".local")
