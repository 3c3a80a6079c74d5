"""The command `thymio-sim node`: runs a ROS 2 program without ROS, as a member of the graph of a suite."""

from __future__ import annotations

import argparse
import contextlib
import itertools
import os
import signal
import sys
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from thymio_sim_ros import course_packages
from thymio_sim_ros.bridge.access import TOKEN_VARIABLE
from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.course_packages import field_checks
from thymio_sim_ros.names.ports import FOXGLOVE_PORT
from thymio_sim_ros.portable_ros import import_hook

__all__ = ["run"]

ROS_ARGS = "--ros-args"
_WITH_VALUE = ("--connect", "--token")
"""Options of this command behind the program, too."""

EPILOG = """\
The program is run unchanged: `import rclpy` and the packages of messages need no ROS 2, and its nodes have topics,
services, actions and parameters in common with all nodes of the server: that of `thymio-sim`, or any other rosbridge
server. Without one, the command waits for it; a lost connection is made again. Ctrl-C ends it.

  thymio-sim node my_node.py
  thymio-sim node my_node.py --connect ws://teacher:8765 --ros-args -p speed:=0.1
"""


def run(argv: Sequence[str]) -> int:
    """Run the program; return the exit code. Raises UsageError for a program that there is not, and a wrong server."""
    own, arguments = _split(argv)
    options = _parser().parse_args(own)
    target = options.module or options.file
    if target is None:
        raise UsageError("node: found no program, expected FILE or -m MODULE")
    if options.module is None and not Path(target).is_file():
        raise UsageError(f"{target}: found no such file, expected a program in Python")
    field_checks.switch_on()
    import_hook.install(is_forced=True)
    course_packages.add_to_path()
    return _run_connected(options, target, arguments)


def _split(words: Iterable[str]) -> tuple[list[str], list[str]]:
    """The words of this command, with the program, and those of the program."""
    own: list[str] = []
    arguments: list[str] = []
    rest = iter(words)
    has_program = False
    for word in rest:
        if word == ROS_ARGS:
            return own, [*arguments, word, *rest]
        is_module = word == "-m" and not has_program
        if is_module or word.partition("=")[0] in _WITH_VALUE:
            own += [word] if "=" in word else [word, *itertools.islice(rest, 1)]
            has_program = has_program or is_module
        elif has_program:
            arguments.append(word)
        else:
            own.append(word)
            has_program = not word.startswith("-")
    return own, arguments


def _run_connected(options: argparse.Namespace, target: str, arguments: Sequence[str]) -> int:
    from thymio_sim_ros.portable_ros.graph.graph import graph_of
    from thymio_sim_ros.portable_ros.program import run_program
    from thymio_sim_ros.portable_ros.rclpy.context import default_domain
    from thymio_sim_ros.portable_ros.rosbridge.transport import RosbridgeError, RosbridgeTransport

    codec = _LazyCodec()
    transport = RosbridgeTransport(graph_of(default_domain()), options.connect, codec, _report, token=options.token)
    try:
        transport.start()
    except RosbridgeError as error:
        raise UsageError(f"node: {error}") from error
    try:
        with _interruptible():
            return run_program(target, arguments, is_module=options.module is not None)
    finally:
        transport.close()


@contextlib.contextmanager
def _interruptible() -> Iterator[None]:
    """Let Ctrl-C raise KeyboardInterrupt in the program, as in every other one. Outside, it ends the process."""
    before = signal.getsignal(signal.SIGINT)
    if before is not signal.SIG_DFL:
        yield
        return
    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, signal.SIG_DFL)


def _report(text: str) -> None:
    print(f"thymio-sim node: {text}", file=sys.stderr, flush=True)


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


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="thymio-sim node",
        usage="thymio-sim node [-h] [--connect URL] [--token TEXT] (FILE | -m MODULE) [ARGUMENT ...] [--ros-args ...]",
        description="Run a ROS 2 program in Python without ROS 2, as a member of the ROS graph of a suite.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("file", nargs="?", metavar="FILE", help="the program; all other arguments are its own")
    parser.add_argument("-m", dest="module", metavar="MODULE", help="run a module in place of a file")
    parser.add_argument(
        "--connect",
        type=_url_argument,
        default=f"ws://127.0.0.1:{FOXGLOVE_PORT}",
        metavar="URL",
        help="address of the server: the one that `thymio-sim` prints for Foxglove (default: %(default)s)",
    )
    parser.add_argument(
        "--token",
        default=os.environ.get(TOKEN_VARIABLE, ""),
        metavar="TEXT",
        help=f"token of the server, if its address has none (default: variable {TOKEN_VARIABLE})",
    )
    return parser


def _url_argument(text: str) -> str:
    scheme, separator, rest = text.partition("://")
    if not separator:
        scheme, rest = "ws", text
    if scheme not in ("ws", "wss") or not rest or rest.startswith(("/", ":")):
        raise argparse.ArgumentTypeError(f"found {text!r}, expected an address such as ws://localhost:8765")
    return f"{scheme}://{rest}"
