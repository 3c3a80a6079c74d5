"""The web pages that may connect: any page in a browser can open a WebSocket to this machine.

Native clients send no Origin and may connect. A page may connect if it comes from this machine, from the Foxglove app,
or from an origin that the user has allowed (`*` allows all). A page may also connect to the numeric address that it was
loaded from, such as that of a robot which serves its own page: unlike a name, a number cannot be rebound to another
host (DNS rebinding).
"""

from __future__ import annotations

import ipaddress
from collections.abc import Collection
from urllib.parse import SplitResult, urlsplit

__all__ = ["is_allowed", "is_local", "is_numeric", "is_same_local_name"]

_FOXGLOVE_APPS = frozenset({"https://app.foxglove.dev", "https://studio.foxglove.dev", "file://"})
"""The hosted app, under both of its names, and desktop applications, whose pages are files."""

_THIS_MACHINE = frozenset({"localhost", "127.0.0.1", "::1"})


def is_allowed(origin: str | None, host: str | None, allowed: Collection[str] = ()) -> bool:
    """Whether a page from `origin` may connect to a server addressed as `host` (header values, None: not sent)."""
    if origin is None or "*" in allowed or origin in allowed or origin in _FOXGLOVE_APPS:
        return True
    return is_local(origin, host)


def is_local(origin: str, host: str | None) -> bool:
    """Whether a page is from this machine, or from the numeric address by which the server is addressed."""
    page = _split(origin)
    if page is None or page.scheme not in ("http", "https") or not page.hostname:
        return False
    if page.hostname in _THIS_MACHINE:
        return True
    server = _split(f"http://{host}")
    return server is not None and page.hostname == server.hostname and is_numeric(page.hostname)


def is_same_local_name(origin: str | None, host: str | None) -> bool:
    """Whether a page is from the name by which the server is addressed, and no foreign page can have that name."""
    page, server = _split(origin or ""), _split(f"http://{host}")
    name = page.hostname if page is not None else None
    if not name or server is None or name != server.hostname:
        return False
    return "." not in name or name.endswith(".local")


def _split(url: str) -> SplitResult | None:
    try:
        return urlsplit(url)
    except ValueError:
        return None


def is_numeric(host: str) -> bool:
    """Whether a host is a numeric address."""
    try:
        ipaddress.ip_address(host)
    except ValueError:
        return False
    return True
