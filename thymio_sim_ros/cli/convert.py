"""The command `thymio-sim convert`: convert playgrounds of other simulators to JSON."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path

from aseba_vm.cli.output import write_file
from thymio_sim_ros.cli.errors import USAGE_ERROR
from thymio_sim_ros.files import resources
from thymio_sim_ros.files.loading import load_playground
from thymio_sim_ros.sim.playground.reader import PlaygroundError, schema
from thymio_sim_ros.sim.playground.writer import dumps

__all__ = ["run"]

INCOMPLETE = 1

EXAMPLE = """\
reads: Aseba .playground files (XML, or a zip with world.xml and its pictures), the JSON of the Thymio web simulation,
and the JSON of this project. FILE#NAME is one of several playgrounds in a zip. Images become part of the result. What
cannot be converted is reported on stderr.

exit code: 0 converted; 1 something cannot be converted (with --strict only, nothing is written); 2 rejected input

example:
  thymio-sim convert thymio-maze.playground -o maze.json && thymio-sim --playground maze.json
"""


def run(argv: Sequence[str]) -> int:
    """Convert one file; return the exit code."""
    options = _parser().parse_args(argv)
    if options.schema:
        return _write(json.dumps(schema(), indent=1) + "\n", options.output)
    try:
        _, playground = load_playground(options.file)
    except (PlaygroundError, resources.ResourceError, OSError) as error:
        return _print_error(str(error), USAGE_ERROR)
    for note in playground.notes:
        _print_error(f"{options.file}: {note}", 0)
    if options.strict and playground.notes:
        return INCOMPLETE
    return _write(dumps(playground), options.output)


def _write(text: str, output: Path | None) -> int:
    try:
        if output is None:
            sys.stdout.buffer.write(text.encode("utf-8"))  # whatever the encoding of the terminal
            sys.stdout.buffer.flush()
        else:
            write_file(str(output), text.encode("utf-8"))
    except BrokenPipeError:
        raise
    except OSError as error:
        return _print_error(
            f"{output or 'standard output'}: {error.strerror}; expected a file that can be written", USAGE_ERROR
        )
    return 0


def _print_error(text: str, code: int) -> int:
    print(f"thymio-sim convert: {text}", file=sys.stderr)
    return code


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="thymio-sim convert",
        description="Convert a playground of another simulator to the JSON of this one.",
        epilog=EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("file", metavar="FILE", nargs="?", help="the playground to convert")
    source.add_argument(
        "--schema", action="store_true", help="write the JSON schema of the format instead, including plug-ins"
    )
    parser.add_argument("-o", "--output", type=Path, metavar="OUT", help="file to write (default: standard output)")
    parser.add_argument("--strict", action="store_true", help="write nothing unless everything can be converted")
    return parser
