"""The commands `thymio-sim topic`, `node list`, `service`, `param`, `action`, `interface`, `record` and `play`."""

from __future__ import annotations

import argparse
import importlib.util
from collections.abc import Sequence

from thymio_sim_ros.bags.arguments import add_play_arguments, add_record_arguments
from thymio_sim_ros.cli.ros.membership import add_membership_options, interruptible, membership
from thymio_sim_ros.cli.ros.workspace import add_to_path
from thymio_sim_ros.ros_commands.arguments import NOUNS, add_verbs

__all__ = ["parser_of", "run"]

_ROS_ARGS = "--ros-args"
_DISCOVERY_S = 5.0
"""Longest wait for what an installed ROS 2 has not discovered yet."""
_BAGS = {
    "record": (add_record_arguments, "record topics in a bag until Ctrl-C"),
    "play": (add_play_arguments, "publish the messages of a bag"),
}
_EPILOG = """\
Without ROS 2 on this computer, or if the suite of this computer uses the embedded graph, the command is a member of the
graph of the suite, or of the server that --connect names. On an installed ROS 2 it is a member of its domain.
"""


def run(argv: Sequence[str]) -> int:
    """Run a command, the first word, on the graph; return the exit code. Raises UsageError."""
    end = argv.index(_ROS_ARGS) if _ROS_ARGS in argv else len(argv)
    options = parser_of(argv[0]).parse_args(argv[:end])
    add_to_path()
    with interruptible(), membership(options, options.command, waits=options.command in _BAGS) as member:
        if options.command in _BAGS:
            from thymio_sim_ros.bags import commands as bags

            return bags.run(options, argv[end:])
        from thymio_sim_ros.ros_commands import commands

        return commands.run(options, argv[end:], 0.0 if member.is_remote else _DISCOVERY_S)


def parser_of(name: str) -> argparse.ArgumentParser:
    """The parser of a command line whose first word is `name`."""
    parser = argparse.ArgumentParser(prog="thymio-sim", allow_abbrev=False)
    commands = parser.add_subparsers(dest="command")
    members = argparse.ArgumentParser(add_help=False)
    add_membership_options(members)
    if name in _BAGS:
        add, text = _BAGS[name]
        bag = commands.add_parser(name, description=f"{text.capitalize()}.", epilog=_EPILOG, parents=[members])
        add(bag)
        return parser
    noun = commands.add_parser(name, description=_description(name), epilog=_EPILOG, allow_abbrev=False)
    add_verbs(noun, name, [members])
    return parser


def _description(noun: str) -> str:
    text = f"The verbs of `ros2 {noun}` that the tutorials need: {', '.join(verb for verb, *_ in NOUNS[noun])}."
    if importlib.util.find_spec(f"ros2{noun}") is not None:
        text += f" `thymio-sim ros2 {noun}` has all verbs, since ros2cli is installed."
    return text
