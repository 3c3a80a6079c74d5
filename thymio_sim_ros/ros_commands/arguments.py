"""The arguments of the commands, named as those of ros2cli."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from pathlib import Path

__all__ = ["NOUNS", "add_verbs"]

_HIDDEN = "--include-hidden-{}"
Add = Callable[[argparse.ArgumentParser], None]


def add_verbs(noun: argparse.ArgumentParser, name: str, parents: list[argparse.ArgumentParser]) -> None:
    """Add the verbs of a noun to its parser; `parents` have the options that all verbs have."""
    verbs = noun.add_subparsers(dest="verb", required=True, metavar="VERB")
    for verb, text, add in NOUNS[name]:
        parser = verbs.add_parser(verb, help=text, description=f"{text}.", parents=parents, allow_abbrev=False)
        add(parser)


def _topic() -> Iterator[tuple[str, str, Add]]:
    def listed(parser: argparse.ArgumentParser) -> None:
        _list_options(parser, "topics")

    def info(parser: argparse.ArgumentParser) -> None:
        parser.add_argument("topic")
        parser.add_argument("-v", "--verbose", action="store_true", help="also show nodes and QoS")

    def echo(parser: argparse.ArgumentParser) -> None:
        _echo_options(parser, "topic", "std_msgs/msg/String; default: that of its publishers")
        parser.add_argument("--once", action="store_true", help="end after the first message")
        parser.add_argument("--field", help="print a part of the message, such as pose.pose.position")

    def window(parser: argparse.ArgumentParser) -> None:
        parser.add_argument("topic")
        parser.add_argument("-w", "--window", type=_count, default=10_000, help="messages that are considered (10000)")

    def pub(parser: argparse.ArgumentParser) -> None:
        _message(parser, "topic", "geometry_msgs/msg/Twist")
        parser.add_argument("-r", "--rate", type=_positive, default=1.0, metavar="HZ", help="messages per second (1)")
        times = parser.add_mutually_exclusive_group()
        times.add_argument("-1", "--once", action="store_const", const=1, dest="times", help="publish one message")
        times.add_argument("-t", "--times", type=_count, help="publish this number of messages")
        parser.add_argument(
            "-w",
            "--wait-matching-subscriptions",
            type=_whole,
            metavar="NUMBER",
            help="wait for this number of subscriptions (1 with --once and --times, otherwise 0)",
        )

    yield "list", "List topics", listed
    yield "echo", "Print the messages of a topic", echo
    yield "hz", "Print how many messages a topic has per second", window
    yield "bw", "Print how many bytes a topic has per second", window
    yield "info", "Print type and endpoints of a topic", info
    yield "type", "Print the type of a topic", lambda parser: _name(parser, "topic")
    yield "find", "List the topics of a type", lambda parser: _find(parser, "topics")
    yield "pub", "Publish messages", pub


def _node() -> Iterator[tuple[str, str, Add]]:
    def listed(parser: argparse.ArgumentParser) -> None:
        parser.add_argument("-a", "--all", action="store_true", dest="include_hidden", help="also list hidden nodes")

    yield "list", "List nodes", listed
    yield "info", "Print topics, services and actions of a node", lambda parser: _name(parser, "node")


def _service() -> Iterator[tuple[str, str, Add]]:
    def call(parser: argparse.ArgumentParser) -> None:
        _message(parser, "service", "std_srvs/srv/SetBool")

    def echo(parser: argparse.ArgumentParser) -> None:
        _echo_options(parser, "service", "std_srvs/srv/SetBool; default: that of its servers")

    yield "list", "List services", lambda parser: _list_options(parser, "services")
    yield "type", "Print the type of a service", lambda parser: _name(parser, "service")
    yield "info", "Print type, clients and servers of a service", lambda parser: _name(parser, "service")
    yield "find", "List the services of a type", lambda parser: _find(parser, "services")
    yield "call", "Call a service and print its response", call
    yield "echo", "Print the requests and responses of a service that reports them", echo


def _param() -> Iterator[tuple[str, str, Add]]:
    def of_node(parser: argparse.ArgumentParser) -> None:
        parser.add_argument("node", nargs="?", help="default: all nodes")

    def get(parser: argparse.ArgumentParser) -> None:
        parser.add_argument("node")
        parser.add_argument("parameter")

    def describe(parser: argparse.ArgumentParser) -> None:
        parser.add_argument("node")
        parser.add_argument("parameters", nargs="+", metavar="parameter")

    def assign(parser: argparse.ArgumentParser) -> None:
        get(parser)
        parser.add_argument("value", help="in YAML: 2.0 is a double, 2 an integer, true a boolean")

    def load(parser: argparse.ArgumentParser) -> None:
        parser.add_argument("node")
        parser.add_argument("file", type=Path, help="a file of parameters, as `param dump` prints it")

    yield "list", "List parameters", of_node
    yield "get", "Print the value of a parameter", get
    yield "set", "Set a parameter", assign
    yield "describe", "Print type, description and limits of parameters", describe
    yield "dump", "Print all parameters of a node as a file of parameters", lambda parser: _name(parser, "node")
    yield "load", "Set the parameters of a node from a file", load


def _action() -> Iterator[tuple[str, str, Add]]:
    def send_goal(parser: argparse.ArgumentParser) -> None:
        _message(parser, "action", "example_interfaces/action/Fibonacci")
        parser.add_argument("-f", "--feedback", action="store_true", help="print feedback, too")

    yield "list", "List actions", lambda parser: _list_options(parser, None)
    yield "info", "Print clients and servers of an action", lambda parser: _name(parser, "action")
    yield "type", "Print the type of an action", lambda parser: _name(parser, "action")
    yield "send_goal", "Send a goal and print its result; Ctrl-C cancels it", send_goal


def _interface() -> Iterator[tuple[str, str, Add]]:
    yield "show", "Print the definition of a type", lambda parser: _name(parser, "type")


def _name(parser: argparse.ArgumentParser, of: str) -> None:
    parser.add_argument(of)


def _echo_options(parser: argparse.ArgumentParser, of: str, type_example: str) -> None:
    parser.add_argument(of)
    parser.add_argument("type", nargs="?", help=f"such as {type_example}")
    parser.add_argument("-f", "--full-length", action="store_true", help="print long lists and texts to their end")
    parser.add_argument("--no-arr", action="store_true", help="print no lists")


def _find(parser: argparse.ArgumentParser, hidden: str) -> None:
    parser.add_argument("type", help="such as std_srvs/srv/Empty")
    _count_and_hidden(parser, hidden)


def _list_options(parser: argparse.ArgumentParser, hidden: str | None) -> None:
    parser.add_argument("-t", "--show-types", action="store_true", help="also print the types")
    _count_and_hidden(parser, hidden)


def _count_and_hidden(parser: argparse.ArgumentParser, hidden: str | None) -> None:
    parser.add_argument("-c", "--count", action="store_true", help="print their number only")
    if hidden is not None:
        name = _HIDDEN.format(hidden)
        parser.add_argument(name, action="store_true", dest="include_hidden", help=f"also list hidden {hidden}")


def _message(parser: argparse.ArgumentParser, of: str, example: str) -> None:
    """Add a name, the type there, and the values of a message; `example` is a type."""
    parser.add_argument(of)
    parser.add_argument("type", help=f"such as {example}")
    parser.add_argument("values", nargs="?", default="{}", help="fields in YAML, such as '{linear: {x: 0.1}}'")


def _whole(text: str) -> int:
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"found {text}, expected a number from 0")
    return int(text)


def _count(text: str) -> int:
    if not text.isdecimal() or int(text) == 0:
        raise argparse.ArgumentTypeError(f"found {text}, expected a number above 0")
    return int(text)


def _positive(text: str) -> float:
    value = float(text)
    if not 0.0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"found {text}, expected a number above 0")
    return value


NOUNS: dict[str, tuple[tuple[str, str, Add], ...]] = {
    "action": tuple(_action()),
    "interface": tuple(_interface()),
    "node": tuple(_node()),
    "param": tuple(_param()),
    "service": tuple(_service()),
    "topic": tuple(_topic()),
}
"""Verb, text and arguments by noun."""
