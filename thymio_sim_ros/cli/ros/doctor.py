"""The command `thymio-sim doctor`: why the robot does not do what a node wants."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING

from aseba_vm.cli.output import standard_output
from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.cli.ros.membership import add_membership_options, membership

if TYPE_CHECKING:
    from thymio_sim_ros.ros.doctor import Examination, TopicUse

__all__ = ["run"]

FAULTS = 1
"""Exit code if something is wrong."""

EPILOG = """\
Run it in the terminal of your node, while the node and `thymio-sim` are running. It prints the topics that your nodes
share with the robot, with the last message, and what is wrong with the cure: names, namespaces, types and QoS that do
not fit, rejected messages, a paused simulation. Exit code: 0 nothing is wrong, 1 something is, 2 no simulator found.
"""


def run(argv: Sequence[str]) -> int:
    """Examine the running suite; return the exit code. Raises UsageError without a simulator."""
    parser = argparse.ArgumentParser(
        prog="thymio-sim doctor",
        description="Say why the robot does not do what a node wants.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("robot", nargs="?", default="", help="name of a robot, if there are several; default: all")
    parser.add_argument("--json", action="store_true", help="print JSON, for programs")
    add_membership_options(parser)
    options = parser.parse_args(argv)
    with membership(options, "doctor") as member:
        from thymio_sim_ros.ros.doctor import NothingFoundError, examine

        try:
            examination = examine(member.where, options.robot)
        except NothingFoundError as error:
            raise UsageError(str(error)) from error
    with standard_output():
        lines = [json.dumps(asdict(examination), indent=2)] if options.json else _lines(examination)
        sys.stdout.writelines(f"{line}\n" for line in lines)
    return FAULTS if examination.faults else 0


def _lines(examination: Examination) -> Iterator[str]:
    robots = ", ".join(name or "one without a name" for name in examination.robots)
    yield f"Playground {examination.playground}, robots: {robots or 'none'}; {examination.where}"
    yield from (
        "",
        "Topics that other nodes share with the robots:" if examination.topics else "No other node uses a topic.",
    )
    for use in examination.topics:
        yield f"  {use.name}  {use.type}"
        sides = (", ".join(side) or "no node" for side in (use.publishers, use.subscribers))
        yield f"    from {' to '.join(sides)}{_last(use)}"
    if examination.faults:
        yield from ("", "What is wrong:", *(f"  {number}. {text}" for number, text in enumerate(examination.faults, 1)))
    else:
        yield from ("", "Nothing is wrong.")
    if examination.notes:
        yield from ("", "To know:", *(f"  - {text}" for text in examination.notes))


def _last(use: TopicUse) -> str:
    if not use.publishers:
        return ""
    return "; no message arrives" if use.age_s is None else f"; {use.age_s:.1f} s ago: {use.last}"
