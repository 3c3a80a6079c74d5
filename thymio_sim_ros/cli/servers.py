"""Options of the servers by which other programs reach the robots, and what the banner says about them."""

from __future__ import annotations

import argparse
import errno
import ipaddress
import re
from dataclasses import dataclass

from thymio_sim_ros.access.hosts import is_loopback
from thymio_sim_ros.access.tokens import Tokens
from thymio_sim_ros.bridge.listening import check_free
from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.names.addresses import describe_urls
from thymio_sim_ros.network.settings import (
    ASEBA_PORT,
    HTTP,
    HTTP_PORT,
    LAST_PORT,
    OFF,
    TDM,
    TDM_PATH,
    TDM_PORT,
    TDM_WS_PORT,
    NetworkSettings,
)
from thymio_sim_ros.suite_config import ADDRESS

__all__ = [
    "Servers",
    "add_server_options",
    "address_argument",
    "port_argument",
    "select_servers",
]

_ORIGIN = re.compile(r"https?://[^/?#\s]+")


@dataclass(frozen=True, slots=True)
class Servers:
    """Settings of the servers, and lines of the banner."""

    settings: NetworkSettings
    lines: tuple[str, ...]


def add_server_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of all servers for other programs."""
    group = parser.add_argument_group("other programs", "servers for Aseba Studio and other tools (docs/networks.md)")
    group.add_argument(
        "--aseba-port",
        type=port_argument,
        metavar="PORT",
        help=f"Aseba port of the first robot, further robots have the next ports (default: {ASEBA_PORT} if it is free)",
    )
    group.add_argument("--aseba-shared", action="store_true", help="all robots on one Aseba port")
    group.add_argument(
        "--aseba-address",
        type=address_argument,
        default=ADDRESS,
        metavar="IPV4",
        help="address of the Aseba ports; 0.0.0.0 is the whole network, from which everyone can then control the "
        "robots, because this protocol has no token (default: %(default)s)",
    )
    group.add_argument("--no-aseba", action="store_true", help="no Aseba port")
    group.add_argument(
        "--tdm-port",
        type=port_argument,
        metavar="PORT",
        help=f"TCP port of the Thymio Device Manager (default: {TDM_PORT} if it is free); it listens on --address, and "
        "clients on other computers give the token as password",
    )
    group.add_argument(
        "--tdm-ws-port",
        type=port_argument,
        metavar="PORT",
        help=f"WebSocket port of the Thymio Device Manager (default: {TDM_WS_PORT} if it is free)",
    )
    group.add_argument(
        "--no-tdm-ports", action="store_true", help=f"Thymio Device Manager on the page's port only, at {TDM_PATH}"
    )
    group.add_argument("--no-tdm", action="store_true", help="no Thymio Device Manager")
    group.add_argument("--http", action="store_true", help="HTTP interface on the page's port")
    group.add_argument(
        "--http-port",
        type=port_argument,
        metavar="PORT",
        help=f"port of the HTTP interface, as asebahttp has it on {HTTP_PORT} (default: none), beside the page's port; "
        "it listens on --address, and clients need the token where page and bridge need it",
    )
    group.add_argument(
        "--allow-origin",
        action="append",
        type=_origin_argument,
        default=[],
        metavar="URL",
        help="let web pages from this origin, such as https://example.org, use the HTTP interface and the Thymio "
        "Device Manager; pages of this computer always may; repeat it for several",
    )
    group.add_argument("--no-announcement", action="store_true", help="do not announce the servers by mDNS")


def select_servers(options: argparse.Namespace, robots: int, tokens: Tokens) -> Servers:
    """The servers that run. One with a default port is off if that port is in use.

    Raises UsageError for a chosen port that cannot be used.
    """
    aseba_port, aseba_line = _aseba(options, robots)
    has_page = not (options.headless or options.no_web)
    tdm_port, tdm_ws_port, tdm_line = _tdm(options, tokens, has_page=has_page)
    http_line = _http(options, tokens, has_page=has_page)
    is_on_page = {TDM: not options.no_tdm, HTTP: options.http or options.http_port is not None}
    settings = NetworkSettings(
        aseba_port=aseba_port,
        aseba_address=options.aseba_address,
        is_aseba_shared=options.aseba_shared,
        address=options.address,
        tdm_port=tdm_port,
        tdm_ws_port=tdm_ws_port,
        http_port=options.http_port or OFF,
        on_page=tuple(name for name, is_on in is_on_page.items() if is_on and has_page),
        allowed_origins=tuple(options.allow_origin),
        is_announced=not options.no_announcement,
    )
    return Servers(settings, tuple(text for text in (aseba_line, tdm_line, http_line) if text))


def _aseba(options: argparse.Namespace, robots: int) -> tuple[int, str]:
    """The port, and the line of the banner."""
    if options.no_aseba or (options.headless and options.aseba_port is None):
        return OFF, ""
    first = options.aseba_port or ASEBA_PORT
    count = 1 if options.aseba_shared else max(robots, 1)
    port = last = first + count - 1
    try:
        if last > LAST_PORT:
            raise OSError(errno.EINVAL, f"expected at most {LAST_PORT}, for robot {count}")
        for port in range(first, last + 1):
            check_free(options.aseba_address, port)
    except OSError as error:
        reason = error.strerror
        if options.aseba_port is not None:
            raise UsageError(f"Aseba port {port}: {reason}; choose another with --aseba-port") from error
        return OFF, (
            f"Aseba     none: {reason}; Thymio Suite or Aseba Playground may be running; another port: --aseba-port"
        )
    places = f"{first}" if count == 1 else f"{first} to {last}"
    host = "localhost" if is_loopback(options.aseba_address) else options.aseba_address
    everyone = "" if is_loopback(options.aseba_address) else ", open to everyone in your network"
    return first, f"Aseba     {host} port {places} (Studio: tcp:host={host};port={first}){everyone}"


def _tdm(options: argparse.Namespace, tokens: Tokens, *, has_page: bool) -> tuple[int, int, str]:
    """The ports for TCP and WebSocket, and the line of the banner."""
    chosen = options.tdm_port, options.tdm_ws_port
    if options.no_tdm or (options.headless and chosen == (None, None)):
        return OFF, TDM_WS_PORT, ""
    scheme = "wss" if options.certificate else "ws"
    page = describe_urls(scheme, options.address, options.port, TDM_PATH) if has_page else "none"
    if options.no_tdm_ports:
        if not has_page or chosen != (None, None):
            raise UsageError("--no-tdm-ports: expected a page, and neither --tdm-port nor --tdm-ws-port")
        return OFF, TDM_WS_PORT, f"TDM       {page}"
    ports = chosen[0] or TDM_PORT, chosen[1] or TDM_WS_PORT
    for port, given, option in zip(ports, chosen, ("--tdm-port", "--tdm-ws-port"), strict=True):
        try:
            check_free(options.address, port)
        except OSError as error:
            if given is not None:
                raise UsageError(f"Thymio Device Manager: {error.strerror}; choose another with {option}") from error
            reason = f"{error.strerror}; Thymio Suite may be running; another port: {option}"
            return OFF, TDM_WS_PORT, f"TDM       {page}{' only' if has_page else ''}: {reason}"
    host = "localhost" if is_loopback(options.address) else options.address
    password = "" if is_loopback(options.address) or not tokens.full else f", password {tokens.full}"
    return *ports, f"TDM       {host} port {ports[0]}, WebSocket {ports[1]} (tdmclient, Scratch, VPL 3){password}"


def _http(options: argparse.Namespace, tokens: Tokens, *, has_page: bool) -> str:
    """The line of the banner."""
    if options.http and not has_page:
        raise UsageError("--http: expected a page; without one, choose a port with --http-port")
    if options.http_port is None and not options.http:
        return ""
    if options.http_port is not None:
        try:
            check_free(options.address, options.http_port)
        except OSError as error:
            raise UsageError(f"HTTP interface: {error.strerror}; choose another with --http-port") from error
    path = f"/nodes?token={tokens.full}" if tokens.full else "/nodes"
    scheme = "https" if options.certificate and options.http_port is None else "http"
    return f"HTTP      {describe_urls(scheme, options.address, options.http_port or options.port, path)}"


def _origin_argument(text: str) -> str:
    if text != "*" and not _ORIGIN.fullmatch(text):
        raise argparse.ArgumentTypeError(f"'{text}' found, expected an origin such as https://example.org:8080, or *")
    return text


def port_argument(text: str) -> int:
    """Read a port. Raises ArgumentTypeError."""
    if not text.isdecimal() or not 1 <= int(text) <= 65535:
        raise argparse.ArgumentTypeError(f"'{text}' found, expected a port from 1 to 65535")
    return int(text)


def address_argument(text: str) -> str:
    """Read an address to listen on. Raises ArgumentTypeError."""
    try:
        return text if text == ADDRESS else str(ipaddress.IPv4Address(text))
    except ValueError as error:
        raise argparse.ArgumentTypeError(
            f"'{text}' found, expected {ADDRESS}, 0.0.0.0 for the whole network, or an IPv4 address of this computer"
        ) from error
