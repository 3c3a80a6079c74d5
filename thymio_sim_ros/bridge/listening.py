"""Listening sockets of all servers."""

from __future__ import annotations

import errno
import socket
from collections.abc import Sequence

__all__ = ["check_free", "detect_lost_peer", "listen"]

_BACKLOG = 128
"""Connections that the kernel queues until they are accepted."""

_RECEIVE_BUFFER = 64 * 1024
"""What the system keeps of a connection that is not read, bytes (Linux: twice as much, and without a limit 6 MB and
more): the messages of a client wait behind what its flooding publisher has sent before."""

_LOOPBACK = ("127.0.0.1", "::1")
"""Addresses of `localhost`: a browser may try either first."""

_NO_ADDRESS = (errno.EADDRNOTAVAIL, errno.EAFNOSUPPORT)
"""Errors on a machine without IPv6; the other loopback address is enough then."""

_EXCLUSIVE: int = getattr(socket, "SO_EXCLUSIVEADDRUSE", socket.SO_REUSEADDR)
"""Option of a port that has one server at a time, and can be used again as soon as it has closed: on Windows,
SO_REUSEADDR would give the port of a running server to a second one."""

_TRIES = 20
"""Attempts to find a port that is free on two addresses."""


_PROBES: tuple[tuple[str, int], ...] = (("TCP_KEEPIDLE", 30), ("TCP_KEEPINTVL", 10), ("TCP_KEEPCNT", 3))
"""When a connection without traffic is probed, s, how often, s, and after how many probes it counts as lost."""
_UNANSWERED_MS = 30_000
"""Time after which a connection whose peer does not confirm sent bytes counts as lost. Linux retries for 15 minutes."""


def detect_lost_peer(connection: socket.socket) -> None:
    """End a TCP connection within a minute after its peer has vanished without closing it, with or without traffic.

    Connections inherit it from a listening socket. Options that the system lacks are left out.
    """
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
    for option, value in (*_PROBES, ("TCP_USER_TIMEOUT", _UNANSWERED_MS)):
        if hasattr(socket, option):
            connection.setsockopt(socket.IPPROTO_TCP, getattr(socket, option), value)


def listen(address: str, port: int) -> list[socket.socket]:
    """Open listening sockets, all on one port; port 0 selects a free one. `localhost` means IPv4 and IPv6 loopback.

    Raises OSError that names address and port.
    """
    return _sockets(address, port, do_listen=True)


def check_free(address: str, port: int) -> None:
    """Raise the OSError that `listen` would raise. The sockets do not listen, so that no client connects meanwhile."""
    for bound in _sockets(address, port, do_listen=False):
        bound.close()


def _sockets(address: str, port: int, *, do_listen: bool) -> list[socket.socket]:
    addresses = _LOOPBACK if address == "localhost" else (address,)
    for is_last in (number == _TRIES for number in range(1, _TRIES + 1)):
        try:
            return _all_bound(addresses, port, do_listen=do_listen)
        except OSError as error:
            if port or is_last or error.errno != errno.EADDRINUSE:
                raise
    raise AssertionError("the last try returns or raises")


def _all_bound(addresses: Sequence[str], port: int, *, do_listen: bool) -> list[socket.socket]:
    sockets: list[socket.socket] = []
    for address in addresses:
        try:
            bound = _bound(address, port, do_listen=do_listen)
        except OSError as error:
            if sockets and error.errno in _NO_ADDRESS:
                continue
            for bound in sockets:
                bound.close()
            raise
        sockets.append(bound)
        port = bound.getsockname()[1]
    return sockets


def _bound(address: str, port: int, *, do_listen: bool) -> socket.socket:
    try:
        info = socket.getaddrinfo(address or None, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)
        family, kind, protocol, _, endpoint = info[0]
        # socket.create_server leaves the protocol at 0, and asyncio then leaves Nagle on: 40 ms per answer (measured).
        bound = socket.socket(family, kind, protocol)
    except OSError as error:
        raise _named(error, address, port) from error
    try:
        bound.setsockopt(socket.SOL_SOCKET, _EXCLUSIVE, 1)
        bound.bind(endpoint)
        if do_listen:
            detect_lost_peer(bound)
            bound.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _RECEIVE_BUFFER)  # connections inherit it
            bound.listen(_BACKLOG)
    except OSError as error:
        bound.close()
        raise _named(error, address, port) from error
    return bound


def _named(error: OSError, address: str, port: int) -> OSError:
    where = f"[{address}]" if ":" in address else address
    return OSError(error.errno, f"cannot listen on {where}:{port}: {(error.strerror or str(error)).lower()}")
