"""The command `thymio-sim foxglove-layout`: a layout of Foxglove or Lichtblick for one robot."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Sequence
from pathlib import Path

from aseba_vm.cli.output import standard_output, write_file
from thymio_sim_ros.cli.errors import USAGE_ERROR
from thymio_sim_ros.studio_layout import APPS, SHIPPED, render

__all__ = ["hint", "run"]

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*(/[A-Za-z][A-Za-z0-9_]*)*")

EXAMPLE = """\
In the application: Layouts, Import from file. For a robot without a namespace, these files are shipped:
  {}

example:
  thymio-sim foxglove-layout --app lichtblick -o thymio.json
  thymio-sim foxglove-layout --robot thymio_1 -o thymio_1.json     (one of several robots)
  thymio-sim foxglove-layout --namespace lab1 -o lab1.json         (of a suite in a namespace)
"""


def run(argv: Sequence[str]) -> int:
    """Write one layout; return the exit code."""
    options = _parser().parse_args(argv)
    text = render(options.app, options.robot, options.namespace)
    if options.output is None:
        with standard_output():
            sys.stdout.write(text)
        return 0
    try:
        write_file(str(options.output), text.encode("utf-8"))
    except OSError as error:
        wrong = f"{options.output}: {error.strerror}; expected a file that can be written"
        print(f"thymio-sim foxglove-layout: {wrong}", file=sys.stderr)
        return USAGE_ERROR
    return 0


def hint(robots: Sequence[str]) -> str:
    """Path of the layout for the robots of a suite, or the command that writes one."""
    if len(robots) == 1:
        return f"{SHIPPED['foxglove']} (for Lichtblick: {SHIPPED['lichtblick'].name} beside it)"
    return f"thymio-sim foxglove-layout --robot {robots[0]} -o {robots[0]}.json (or of another robot)"


def _namespace(text: str) -> str:
    name = text.strip("/")
    if name and _NAME.fullmatch(name) is None:
        raise argparse.ArgumentTypeError(
            f"'{text}' found, expected a namespace of letters, digits and _, such as thymio_1"
        )
    return name


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="thymio-sim foxglove-layout",
        description="Print a layout for Foxglove or Lichtblick: 3D, plots, teleop, lights, program, parameters, log.",
        epilog=EXAMPLE.format("\n  ".join(str(path) for path in SHIPPED.values())),
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument(
        "--robot", type=_namespace, default="", metavar="NAME", help="name of the robot, if there are several"
    )
    parser.add_argument(
        "--namespace", type=_namespace, default="", metavar="NAME", help="namespace of the whole suite, if it has one"
    )
    parser.add_argument("--app", choices=APPS, default="foxglove", help="which application (default: %(default)s)")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE", help="file to write (default: standard output)")
    return parser
