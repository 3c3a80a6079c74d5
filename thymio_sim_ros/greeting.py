"""What a person reads when the suite has started: where to look, from here and from elsewhere."""

from __future__ import annotations

import ipaddress
import socket
from collections.abc import Sequence

from thymio_sim_ros import foxglove_layout
from thymio_sim_ros.suite import ADDRESS, Suite

__all__ = ["greeting", "own_address"]

_SOMEWHERE = ("192.0.2.1", 9)
"""Of a network that nobody has (RFC 5737); nothing is sent there."""
_NONE = "none (started without it)"


def greeting(suite: Suite, robots: Sequence[str]) -> str:
    """The lines a person needs."""
    page = _places("http", suite.address, suite.port, "/") if suite.web else _NONE
    foxglove = _places("ws", suite.address, suite.foxglove_port) if suite.foxglove else _NONE
    layout = f"\nLayout    {foxglove_layout.hint(robots)}" if suite.foxglove else ""
    return f"Page      {page}\nFoxglove  {foxglove}{layout}\nStop      Ctrl-C"


def own_address() -> str:
    """The number by which other computers reach this one; the name of this one where there is no network."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(_SOMEWHERE)
        except OSError:
            return socket.gethostname()
        return str(probe.getsockname()[0])


def _places(scheme: str, address: str, port: int, path: str = "") -> str:
    if address == ADDRESS or ipaddress.ip_address(address).is_loopback:
        return f"{scheme}://localhost:{port}{path}"
    if not ipaddress.ip_address(address).is_unspecified:
        return f"{scheme}://{address}:{port}{path}"
    return f"{scheme}://localhost:{port}{path}, from other computers {scheme}://{own_address()}:{port}{path}"
