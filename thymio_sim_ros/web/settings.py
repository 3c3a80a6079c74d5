"""Settings of the page's server."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Settings", "max_connections"]

_MAX_CONNECTIONS = 768
"""Enough for 180 browsers that open the page at the same time."""
_MAX_CONNECTIONS_WITHOUT_LIMITS = 384
"""On Windows, where an event loop waits for at most 512 sockets."""


def max_connections() -> int:
    """Maximum number of connections: at most three quarters of the files that this process may open."""
    try:
        from resource import RLIM_INFINITY, RLIMIT_NOFILE, getrlimit
    except ImportError:  # not on Windows, where a folder of this name may be found instead
        return _MAX_CONNECTIONS_WITHOUT_LIMITS
    soft, _ = getrlimit(RLIMIT_NOFILE)
    return _MAX_CONNECTIONS if soft == RLIM_INFINITY else max(8, min(_MAX_CONNECTIONS, soft * 3 // 4))


@dataclass(frozen=True, slots=True)
class Settings:
    """Limits of the page's server.

    `foxglove_port` is the port of the bridge on the same host; negative: that of the page. `is_loopback` is true if the
    server listens for this computer only; requests must then address it by a name of loopback or one of
    `allowed_hosts`, so that a foreign page whose name resolves to this computer (DNS rebinding) cannot read anything.
    """

    foxglove_port: int = -1
    is_loopback: bool = True
    allowed_hosts: tuple[str, ...] = ()
