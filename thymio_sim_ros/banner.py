"""The banner printed when the suite has started: addresses for this computer and for others."""

from __future__ import annotations

import io
import ipaddress
import os
import socket
from collections.abc import Sequence

from thymio_sim_ros.bridge.access import Tokens, is_loopback
from thymio_sim_ros.cli import foxglove_layout
from thymio_sim_ros.domain import describe_domain
from thymio_sim_ros.suite_config import SuiteConfig

__all__ = ["access", "banner", "own_address", "places", "qr_code", "startup_notice", "urls"]

_SOMEWHERE = ("192.0.2.1", 9)
"""Of a network that nobody has (RFC 5737); nothing is sent there."""
_LOCALHOST = ("127.0.0.1", "::1")
_NONE = "none (started without it)"
_HUNDRED_S = 67.0
"""How long a hundred robots take to start in one process, where DDS compares each of their topics with all others; it
goes with the square of their number (measured, docs/performance.md)."""
_LONG_S = 5.0


def banner(suite: SuiteConfig, robots: Sequence[str]) -> str:
    """The lines a person needs. They contain the tokens: for standard output, never for a log."""
    tokens = suite.tokens or Tokens()
    page = places("http", suite.address, suite.port, "/", tokens.full) if suite.web else _NONE
    path = "/" if tokens.full else ""
    foxglove = places("ws", suite.address, suite.foxglove_port, path, tokens.full) if suite.foxglove else _NONE
    lines = [f"Page      {page}", f"Foxglove  {foxglove}"]
    if suite.foxglove:
        lines += [f"Read only {place}" for place in _read_only_places(suite, tokens)]
        lines.append(f"Layout    {foxglove_layout.hint(robots)}")
        lines.append(f"Access    {access(suite.address, tokens)}")
    return "\n".join([*lines, f"Domain    {describe_domain(os.environ)}", "Stop      Ctrl-C"])


def access(address: str, tokens: Tokens) -> str:
    """Who can reach what, in one line."""
    if is_loopback(address):
        return f"this computer only{', with the token' if tokens.is_required else ''}"
    if not tokens.is_required:
        return "everyone in your network, without a token: drive, program, load, add robots"
    everything = "everyone in your network with a full address: drive, program, load, add robots"
    return f"{everything}; with a read-only address: watch"


def qr_code(suite: SuiteConfig) -> str:
    """The page's address for other computers as a QR code in terminal characters; empty where there is none."""
    tokens = suite.tokens or Tokens()
    if not suite.web or is_loopback(suite.address):
        return ""
    try:
        import segno
    except ImportError:  # not among the packages of every ROS installation
        return ""
    drawn = io.StringIO()
    url = urls("http", suite.address, suite.port, "/", tokens.full)[-1]
    segno.make_qr(url, error="l").terminal(drawn, border=2, compact=True)
    return drawn.getvalue().rstrip("\n")


def _read_only_places(suite: SuiteConfig, tokens: Tokens) -> list[str]:
    """For the class: the page and the bridge for other computers, with the token that only lets watch."""
    if not tokens.read_only:
        return []
    page = urls("http", suite.address, suite.port, "/", tokens.read_only)[-1:] if suite.web else []
    return [*page, urls("ws", suite.address, suite.foxglove_port, "/", tokens.read_only)[-1]]


def startup_notice(robots: int) -> str | None:
    """A line that announces a long start, or None for a short one."""
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


def places(scheme: str, address: str, port: int, path: str = "", token: str = "") -> str:
    """Where something is that listens on an address, for a person."""
    return ", from other computers ".join(urls(scheme, address, port, path, token))


def urls(scheme: str, address: str, port: int, path: str = "", token: str = "") -> list[str]:
    """The same for programs; `address` is a name or a number.

    Of the whole network (`0.0.0.0`, `::`) that for this computer comes first, then that for others. A token is in the
    query of a WebSocket's address; in that of a page it is the fragment, which browsers send to no server.
    """
    suffix = "" if not token else f"?token={token}" if scheme.startswith("ws") else f"#token={token}"
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
    return [f"{scheme}://{host}:{port}{path}{suffix}" for host in hosts]
