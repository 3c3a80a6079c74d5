"""The command `thymio-sim node`: runs a ROS 2 program without ROS, as a member of the graph of a suite."""

from __future__ import annotations

import argparse
import atexit
import itertools
from collections.abc import Callable, Iterable, Sequence
from contextlib import ExitStack
from pathlib import Path
from socket import socket

from thymio_sim_ros import course_packages
from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.cli.ros import tools
from thymio_sim_ros.cli.ros.membership import add_server_options, connected, interruptible
from thymio_sim_ros.course_packages import field_checks
from thymio_sim_ros.portable_ros import import_hook
from thymio_sim_ros.ros_commands.arguments import NOUNS

__all__ = ["prepare", "run", "run_connected"]

ROS_ARGS = "--ros-args"
_NOUN = "node"
_VERBS = [verb for verb, *_ in NOUNS[_NOUN]]
"""First words that are no program but a verb of `ros2 node`."""
_WITH_VALUE = ("--connect", "--token")
"""Options of this command behind the program, too."""

EPILOG = """\
The program is run unchanged: `import rclpy` and the packages of messages need no ROS 2, and its nodes have topics,
services, actions and parameters in common with all nodes of the server: that of `thymio-sim`, or any other rosbridge
server. Without one, the command waits for it; a lost connection is made again. Ctrl-C ends it.

  thymio-sim node my_node.py
  thymio-sim node my_node.py --connect ws://teacher:8765 --ros-args -p speed:=0.1

`thymio-sim node list` and `thymio-sim node info NAME` are those of `ros2 node`.
"""


def run(argv: Sequence[str]) -> int:
    """Run the program; return the exit code. Raises UsageError for a program that there is not, and a wrong server."""
    if argv and argv[0] in _VERBS:
        return tools.run([_NOUN, *argv])
    own, arguments = _split(argv)
    options = _parser().parse_args(own)
    target = options.module or options.file
    if target is None:
        raise UsageError("node: found no program, expected FILE or -m MODULE")
    if options.module is None and not Path(target).is_file():
        raise UsageError(f"{target}: found no such file, expected a program in Python")
    prepare()
    return run_connected(
        target, arguments, url=options.connect, token=options.token, is_module=options.module is not None
    )


def prepare() -> None:
    """Serve rclpy and messages of the embedded graph to the program of this process."""
    field_checks.switch_on()
    import_hook.install(is_forced=True)
    course_packages.add_to_path()


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


def run_connected(
    target: str,
    arguments: Sequence[str],
    *,
    url: str,
    token: str,
    is_module: bool = False,
    link: socket | None = None,
    begin: Callable[[], object] = lambda: None,
) -> int:
    """Run a program as a member of the graph of a server; return its exit code. `prepare` comes first.

    `link` is a connection with the server, where the process may not make one; `begin` is called when all is
    ready for the program. The connection lasts until the threads of the program have ended, and its pools of threads.
    Python waits for both when it ends, then it calls what `atexit` has. Ctrl-C ends this process by its signal, without
    all that. Raises UsageError for a server that rejects the connection.
    """
    from thymio_sim_ros.portable_ros.program import run_program

    connection = ExitStack()
    connection.enter_context(connected(url, token, "node", waits=link is None, link=link))
    connection.enter_context(interruptible())
    atexit.register(connection.close)
    try:
        begin()
        return run_program(target, arguments, is_module=is_module)
    except KeyboardInterrupt:
        connection.close()
        raise


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
    add_server_options(parser)
    return parser
