"""The banner printed when the suite has started: addresses for this computer and for others."""

from __future__ import annotations

import io
from collections.abc import Sequence

from thymio_sim_ros.access.hosts import is_loopback
from thymio_sim_ros.access.tokens import Tokens
from thymio_sim_ros.cli import foxglove_layout
from thymio_sim_ros.names.addresses import describe_access, loopback_problem, urls
from thymio_sim_ros.network.robot_target import parse_target
from thymio_sim_ros.network.settings import OFF
from thymio_sim_ros.suite_config import SuiteConfig

__all__ = ["banner", "qr_code", "startup_notice"]

_NONE = "none (started without it)"
_ON_LINE = ", from other computers "
_ROBOT_S = 0.1
"""Start time of each robot (measured, docs/performance-method.md)."""
_LONG_START_S = 5.0


def banner(suite: SuiteConfig, robots: Sequence[str], servers: Sequence[str] = ()) -> str:
    """Lines for the user, with those of the `servers` for other programs.

    They contain the tokens: print them on standard output, never in a log.
    """
    tokens = suite.tokens or Tokens()
    page = _ON_LINE.join(_page_urls(suite, tokens.full)) if suite.web else _NONE
    bridge = _ON_LINE.join(_bridge_urls(suite, tokens.full)) if suite.foxglove else _NONE
    lines = [f"Page      {page}", f"Foxglove  {bridge}"]
    if suite.foxglove:
        lines += [f"Read only {url}" for url in _read_only_urls(suite, tokens)]
        lines.append(f"Layout    {foxglove_layout.hint(robots)}")
        lines.append(f"Access    {describe_access(suite.address, tokens, is_proxied=bool(suite.trusted_proxies))}")
    lines += servers
    problem = loopback_problem()
    if problem:
        lines.insert(0, f"Network   this computer cannot reach itself ({problem}): switch its interface lo on")
    if suite.robot:
        lines.insert(0, f"Robot     {parse_target(suite.robot)} (real robot: no simulation, no ground truth)")
    return "\n".join([*lines, "Stop      Ctrl-C"])


def qr_code(suite: SuiteConfig) -> str:
    """The page's URL for other computers as a QR code in terminal characters; empty if there is no such URL."""
    tokens = suite.tokens or Tokens()
    if not suite.web or is_loopback(suite.address):
        return ""
    try:
        import segno
    except ImportError:  # not among the packages of every ROS installation
        return ""
    drawn = io.StringIO()
    url = _page_urls(suite, tokens.full)[-1]
    segno.make_qr(url, error="l").terminal(drawn, border=2, compact=True)
    return drawn.getvalue().rstrip("\n")


def startup_notice(robots: int) -> str | None:
    """A line that announces a start of more than `_LONG_START_S`; None for a shorter one."""
    seconds = _ROBOT_S * robots
    return None if seconds < _LONG_START_S else f"Start     {robots} robots: this takes about {seconds:.0f} s"


def _read_only_urls(suite: SuiteConfig, tokens: Tokens) -> list[str]:
    """URLs of page and bridge for other computers with the read-only token; empty without such a token."""
    if not tokens.read_only:
        return []
    page = _page_urls(suite, tokens.read_only)[-1:] if suite.web else []
    return [*page, _bridge_urls(suite, tokens.read_only)[-1]]


def _page_urls(suite: SuiteConfig, token: str) -> list[str]:
    return urls("https" if suite.certificate else "http", suite.address, suite.port, "/", token)


def _bridge_urls(suite: SuiteConfig, token: str) -> list[str]:
    port = suite.port if suite.foxglove_port == OFF else suite.foxglove_port
    return urls("wss" if suite.certificate else "ws", suite.address, port, "/" if token else "", token)
