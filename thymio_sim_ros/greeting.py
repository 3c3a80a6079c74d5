"""What a person reads when the suite has started: where to look, from here and from elsewhere."""

from __future__ import annotations

import ipaddress
import socket
from collections.abc import Sequence

from thymio_sim_ros import foxglove_layout
from thymio_sim_ros.suite import Suite

__all__ = ["greeting", "own_address", "patience", "places", "urls"]

_SOMEWHERE = ("192.0.2.1", 9)
"""Of a network that nobody has (RFC 5737); nothing is sent there."""
_LOCALHOST = ("127.0.0.1", "::1")
_NONE = "none (started without it)"
_HUNDRED_S = 67.0
"""How long a hundred robots take to start in one process, where DDS compares each of their topics with all others; it
goes with the square of their number (measured, docs/performance.md)."""
_LONG_S = 5.0


def greeting(suite: Suite, robots: Sequence[str]) -> str:
    """The lines a person needs."""
    page = places("http", suite.address, suite.port, "/") if suite.web else _NONE
    foxglove = places("ws", suite.address, suite.foxglove_port) if suite.foxglove else _NONE
    layout = f"\nLayout    {foxglove_layout.hint(robots)}" if suite.foxglove else ""
    return f"Page      {page}\nFoxglove  {foxglove}{layout}\nStop      Ctrl-C"


def patience(robots: int) -> str | None:
    """A line for somebody who has to wait before there is anything to see; None when it is not long."""
    seconds = _HUNDRED_S * (robots / 100) ** 2
    return None if seconds < _LONG_S else f"Start     {robots} robots: this takes about {seconds:.0f} s"


def own_address() -> str:
    """The number by which other computers reach this one; the name of this one where there is no network."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(_SOMEWHERE)
        except OSError:
            return socket.gethostname()
        return str(probe.getsockname()[0])


def places(scheme: str, address: str, port: int, path: str = "") -> str:
    """Where something is that listens on an address, for a person."""
    return ", from other computers ".join(urls(scheme, address, port, path))


def urls(scheme: str, address: str, port: int, path: str = "") -> list[str]:
    """The same for programs; `address` is a name or a number.

    Of the whole network (`0.0.0.0`, `::`) that for this computer comes first, then that for others.
    """
    hosts = [address]
    try:
        number = ipaddress.ip_address(address)
    except ValueError:
        pass
    else:
        if address in _LOCALHOST:
            hosts = ["localhost"]
        elif number.is_unspecified:
            hosts = ["localhost", own_address()]
        elif number.version == 6:
            hosts = [f"[{address}]"]
    return [f"{scheme}://{host}:{port}{path}" for host in hosts]
