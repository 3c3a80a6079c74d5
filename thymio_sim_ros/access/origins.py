"""The web pages that may connect: any page in a browser can make requests to this machine.

A page may connect if it comes from this machine, or from an origin that the user has allowed (`*` allows all). A page
may also connect to the numeric address that it was loaded from, such as that of a robot which serves its own page:
unlike a name, a number cannot be rebound to another host (DNS rebinding).
"""

from __future__ import annotations

from collections.abc import Collection
from urllib.parse import SplitResult, urlsplit

from thymio_sim_ros.access.hosts import is_numeric, is_private_name

__all__ = ["FOXGLOVE_APPS", "is_allowed", "is_same_private_name"]

FOXGLOVE_APPS = ("https://app.foxglove.dev", "https://studio.foxglove.dev", "file://")
"""Origins of the hosted app, under both of its names, and of desktop applications, whose pages are files."""

_THIS_MACHINE = frozenset({"localhost", "127.0.0.1", "::1"})


def is_allowed(origin: str | None, host: str | None, allowed: Collection[str] = ()) -> bool:
    """Whether a page from `origin` may connect to a server addressed as `host`, both as in a request's headers.

    Programs send no Origin (None), and may connect.
    """
    if origin is None or "*" in allowed or origin in allowed:
        return True
    page = _split(origin)
    if page is None or page.scheme not in ("http", "https") or not page.hostname:
        return False
    if page.hostname in _THIS_MACHINE:
        return True
    server = _split(f"http://{host}")
    return server is not None and page.hostname == server.hostname and is_numeric(page.hostname)


def is_same_private_name(origin: str | None, host: str | None) -> bool:
    """Whether a page is from the name by which the server is addressed, and no foreign page can have that name."""
    page, server = _split(origin or ""), _split(f"http://{host}")
    name = page.hostname if page is not None else None
    return bool(name) and server is not None and name == server.hostname and is_private_name(str(name))


def _split(url: str) -> SplitResult | None:
    try:
        return urlsplit(url)
    except ValueError:
        return None
