"""Names by which a server may be addressed.

A server on loopback must not answer requests for any other name: a foreign page whose name resolves to this computer
(DNS rebinding) is, for the browser, a page of this server.
"""

from __future__ import annotations

import ipaddress
import re
from collections.abc import Collection

__all__ = ["host_name", "is_loopback_name"]

_HOST = re.compile(r"(?P<name>[a-z0-9_.-]+|\[[0-9a-f:.]+\])(?::\d{1,5})?", re.IGNORECASE)


def host_name(host: str) -> str | None:
    """The name or address in a Host header, without brackets and port; None if it is invalid."""
    match = _HOST.fullmatch(host)
    return None if match is None else match["name"].strip("[]").lower()


def is_loopback_name(name: str | None, allowed: Collection[str] = ()) -> bool:
    """Whether a request may address a server on loopback by this name; None: the name of the request is invalid."""
    if name is None:
        return False
    if name == "localhost" or name.endswith(".localhost") or name in allowed:
        return True
    try:
        return ipaddress.ip_address(name).is_loopback
    except ValueError:
        return False
