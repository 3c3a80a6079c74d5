"""How a command becomes a member of the ROS graph of a suite: by its rosbridge server, or on an installed ROS 2."""

from __future__ import annotations

import argparse
import contextlib
import importlib.util
import os
import signal
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from socket import socket
from typing import Any

from thymio_sim_ros import course_packages
from thymio_sim_ros.access.tokens import TOKEN_VARIABLE
from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.cli.ros.graph_choice import check_ros
from thymio_sim_ros.names.domain import describe_domain
from thymio_sim_ros.names.ports import FOXGLOVE_PORT
from thymio_sim_ros.portable_ros import import_hook

__all__ = [
    "CONNECT_VARIABLE",
    "Membership",
    "add_membership_options",
    "add_server_options",
    "connected",
    "interruptible",
    "membership",
]

CONNECT_VARIABLE = "THYMIO_SIM_CONNECT"
"""The address of the server where no option names it."""

_KINDS = {True: "the embedded graph", False: "the ROS 2 graph", None: "the graph"}
_SUITE_HERE = f"ws://127.0.0.1:{FOXGLOVE_PORT}"


@dataclass(frozen=True, slots=True)
class Membership:
    """On which graph a command is."""

    where: str
    """The graph in words."""
    is_remote: bool
    """Whether its nodes are known from the start, by a server, and need no discovery."""


def add_server_options(parser: argparse.ArgumentParser) -> None:
    """Add `--connect` and `--token`."""
    _add_connect(parser, default=_SUITE_HERE)
    _add_token(parser)


def add_membership_options(parser: argparse.ArgumentParser) -> None:
    """Add the options that choose a graph: that of a server, or that of an installed ROS 2."""
    graphs = parser.add_mutually_exclusive_group()
    _add_connect(graphs)
    graphs.add_argument(
        "--ros",
        action="store_true",
        help="use an installed ROS 2 also if the suite of this computer does not (default: the graph of that suite)",
    )
    _add_token(parser)


def _add_connect(to: argparse._ActionsContainer, default: str | None = None) -> None:
    to.add_argument(
        "--connect",
        type=_url_argument,
        default=os.environ.get(CONNECT_VARIABLE, default),
        metavar="URL",
        help="address of the server: the one that `thymio-sim` prints for Foxglove"
        f" (default: variable {CONNECT_VARIABLE}, or {default or 'the suite of this computer'})",
    )


def _add_token(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--token",
        default=os.environ.get(TOKEN_VARIABLE, ""),
        metavar="TEXT",
        help=f"token of the server, if its address has none (default: variable {TOKEN_VARIABLE})",
    )


@contextlib.contextmanager
def membership(options: argparse.Namespace, name: str, *, waits: bool = False) -> Iterator[Membership]:
    """Make rclpy of this process that of the chosen graph, and connect it if it is elsewhere.

    `name` is that of the command, for lines about the connection; `waits` for a server, of which there is none.
    Raises UsageError.
    """
    url = options.connect or _SUITE_HERE
    if not options.ros:
        from thymio_sim_ros.portable_ros.rosbridge.server_kind import is_embedded

        kind = is_embedded(url, options.token)
        if options.connect or kind or importlib.util.find_spec("rclpy") is None:
            import_hook.install(is_forced=True)
            course_packages.add_to_path()
            with connected(url, options.token, name, waits=waits):
                yield Membership(f"{_KINDS[kind]} of {url.partition('?')[0]}", is_remote=True)
            return
    check_ros()
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    course_packages.add_to_path()
    from thymio_sim_ros.ros.compat import dds_profile

    with dds_profile.used(dds_profile.ANNOUNCING):
        yield Membership(f"ROS 2, {describe_domain(os.environ)}", is_remote=False)


@contextlib.contextmanager
def connected(url: str, token: str, name: str, *, waits: bool, link: socket | None = None) -> Iterator[None]:
    """Connect the embedded graph of this process with a server, at first by `link` if there is one.

    The hook has to be installed. Raises UsageError.
    """
    from thymio_sim_ros.portable_ros.graph.graph import graph_of
    from thymio_sim_ros.portable_ros.rclpy.context import default_domain
    from thymio_sim_ros.portable_ros.rosbridge.transport import RosbridgeError, RosbridgeTransport

    def report(text: str) -> None:
        print(f"thymio-sim {name}: {text}", file=sys.stderr, flush=True)

    transport = RosbridgeTransport(
        graph_of(default_domain()), url, _LazyCodec(), report, token=token, waits=waits, link=link
    )
    try:
        transport.start()
    except RosbridgeError as error:
        raise UsageError(f"{name}: {error}") from error
    try:
        yield
    finally:
        transport.close()


@contextlib.contextmanager
def interruptible() -> Iterator[None]:
    """Let Ctrl-C raise KeyboardInterrupt in a program, as in every other one. Outside, it ends the process."""
    before = signal.getsignal(signal.SIGINT)
    if before is not signal.SIG_DFL:
        yield
        return
    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, signal.SIG_DFL)


class _LazyCodec:
    """The conversion of messages to JSON, which only servers other than a suite need; imported when it is used."""

    def to_json(self, message: Any) -> bytes:
        """The UTF-8 JSON of a message."""
        from thymio_sim_ros.ros.foxglove.json_messages import to_json

        return to_json(message)

    def from_json(self, data: bytes, message_type: type[Any]) -> Any:
        """The message of a class that UTF-8 JSON stands for. Raises ValueError."""
        from thymio_sim_ros.ros.foxglove.json_messages import from_json

        return from_json(data, message_type)


def _url_argument(text: str) -> str:
    scheme, separator, rest = text.partition("://")
    if not separator:
        scheme, rest = "ws", text
    if scheme not in ("ws", "wss") or not rest or rest.startswith(("/", ":")):
        raise argparse.ArgumentTypeError(f"found {text!r}, expected an address such as ws://localhost:8765")
    return f"{scheme}://{rest}"
