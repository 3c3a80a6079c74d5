"""Options of page and bridge: where they listen, who may connect, and their certificate."""

from __future__ import annotations

import argparse
import os
import ssl
import sys

from thymio_sim_ros.access.tokens import READ_ONLY_VARIABLE, TOKEN, TOKEN_VARIABLE, Tokens
from thymio_sim_ros.access.visitor import ProxyError, TrustedProxies
from thymio_sim_ros.bridge.listening import check_free
from thymio_sim_ros.bridge.tls import TlsError, tls_context
from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.cli.servers import add_server_options, address_argument, port_argument
from thymio_sim_ros.page_nodes.who import Who
from thymio_sim_ros.suite_config import ADDRESS, SuiteConfig

__all__ = [
    "add_certificate_options",
    "add_nodes_option",
    "add_page_options",
    "add_proxy_option",
    "check_port",
    "given_certificate",
    "given_nodes",
    "given_tokens",
]


def add_page_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of page, bridge and other servers."""
    parser.add_argument(
        "--address",
        type=address_argument,
        default=SuiteConfig.address,
        metavar="IPV4",
        help="address on which page and bridge listen; 0.0.0.0 is the whole network, where clients need the token in "
        "the printed address (default: %(default)s)",
    )
    parser.add_argument(
        "--token",
        type=_token_argument,
        metavar="TEXT",
        help=f"token that clients need, instead of a random one; other users of this computer can see it in the list "
        f"of processes, unless it is in the variable {TOKEN_VARIABLE}",
    )
    parser.add_argument(
        "--read-only-token",
        type=_token_argument,
        metavar="TEXT",
        help=f"token with which clients only watch, instead of a random one; or {READ_ONLY_VARIABLE}",
    )
    parser.add_argument(
        "--no-token", action="store_true", help="give full access without a token to all clients that reach the address"
    )
    parser.add_argument(
        "--port", type=port_argument, default=SuiteConfig.port, help="port of the page (default: %(default)s)"
    )
    parser.add_argument(
        "--foxglove-port",
        type=port_argument,
        default=SuiteConfig.foxglove_port,
        help="port of the bridge, as Foxglove expects it (default: %(default)s); the bridge is on the page's port, too",
    )
    parser.add_argument("--no-foxglove-port", action="store_true", help="bridge and page on the page's port only")
    add_nodes_option(parser)
    add_certificate_options(parser, "page and bridge speak")
    add_proxy_option(parser)
    add_server_options(parser)
    parser.add_argument("--no-web", action="store_true", help="no web page; Foxglove can still connect")
    parser.add_argument("--headless", action="store_true", help="only the ROS nodes: no page, no Foxglove bridge")


def add_nodes_option(parser: argparse.ArgumentParser) -> None:
    """Add the option for ROS nodes that are written on the page."""
    parser.add_argument(
        "--nodes",
        action=argparse.BooleanOptionalAction,
        default=None,
        help="who may run ROS nodes that are written on the page, Python that this computer executes: all with full "
        "access, those of others in isolation, which needs Linux; or none (default: the user of this computer)",
    )


def given_nodes(options: argparse.Namespace) -> Who:
    """Who may run nodes. Raises UsageError where nodes of others cannot be isolated."""
    if options.nodes and not sys.platform.startswith("linux"):
        raise UsageError("--nodes: nodes of other computers need the isolation of Linux; without it, yours run")
    return Who.LOCAL if options.nodes is None else Who.ALL if options.nodes else Who.NONE


def add_certificate_options(parser: argparse.ArgumentParser, use: str) -> None:
    """Add the options for TLS; `use` is the begin of "… https", for the help."""
    parser.add_argument(
        "--certificate",
        default=SuiteConfig.certificate,
        metavar="FILE",
        help=f"PEM file with a certificate, with which {use} https and wss",
    )
    parser.add_argument(
        "--key", default=SuiteConfig.key, metavar="FILE", help="PEM file with its private key, unless the first has it"
    )


def add_proxy_option(parser: argparse.ArgumentParser) -> None:
    """Add the option for reverse proxies."""
    parser.add_argument(
        "--trusted-proxy",
        action="append",
        type=_proxy_argument,
        default=[],
        metavar="ADDRESS|NETWORK",
        help="a reverse proxy, such as 127.0.0.1 or 10.1.0.0/16, whose headers X-Forwarded-For, -Proto, -Host and "
        "-Prefix are believed (docs/serve-a-school.md); repeat it for several",
    )


def _proxy_argument(text: str) -> str:
    try:
        TrustedProxies([text])
    except ProxyError as error:
        raise argparse.ArgumentTypeError(str(error)) from error
    return text


def _token_argument(text: str) -> str:
    if not TOKEN.fullmatch(text):
        raise argparse.ArgumentTypeError("expected 4 to 200 letters, digits, '.', '_', '~' or '-'")
    return text


def given_tokens(options: argparse.Namespace) -> Tokens:
    """Tokens that clients need. Raises UsageError for tokens that contradict each other."""
    given = options.token, options.read_only_token
    if options.no_token:
        if any(given):
            raise UsageError("--no-token: expected no other option for tokens")
        return Tokens()
    full, read_only = given[0] or _token_variable(TOKEN_VARIABLE), given[1] or _token_variable(READ_ONLY_VARIABLE)
    if full and full == read_only:
        raise UsageError("the token and the read-only token are the same; expected two different ones")
    return Tokens.for_address(options.address, full, read_only, is_proxied=bool(options.trusted_proxy))


def _token_variable(variable: str) -> str:
    """Token in an environment variable, or "". Raises UsageError without showing the token."""
    text = os.environ.get(variable, "")
    try:
        return _token_argument(text) if text else ""
    except argparse.ArgumentTypeError as error:
        raise UsageError(f"{variable}: {error}") from error


def check_port(address: str, port: int, server: str, option: str) -> None:
    """Raise UsageError for a port that cannot be used."""
    try:
        check_free(address, port)
    except OSError as error:
        options = option if address == ADDRESS else f"{option} or --address"
        raise UsageError(f"port {port} of {server}: {error.strerror}; choose another with {options}") from error


def given_certificate(options: argparse.Namespace) -> ssl.SSLContext | None:
    """The context of the options for TLS; None without. Raises UsageError for files with which no client connects."""
    if options.key and not options.certificate:
        raise UsageError("--key: expected --certificate, too")
    try:
        return tls_context(options.certificate, options.key) if options.certificate else None
    except TlsError as error:
        raise UsageError(f"--certificate: {error}") from error
