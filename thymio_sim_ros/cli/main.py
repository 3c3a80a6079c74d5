"""The command `thymio-sim`: selects the subcommand, and turns its errors into one line on stderr and an exit code.

All input is checked before anything starts.
"""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable, Mapping, Sequence

from aseba_vm.cli.output import STANDARD_OUTPUT, exit_by_signal
from thymio_sim_ros.cli import classroom, convert, doctor, env, foxglove_layout, grade, replay, runner, suite, sweep
from thymio_sim_ros.cli.errors import USAGE_ERROR, UsageError

__all__ = ["main"]

COMMANDS: Mapping[str, Callable[[Sequence[str]], int]] = {
    "runner": runner.run,
    "class": classroom.run,
    "convert": convert.run,
    "doctor": doctor.run,
    "env": env.run,
    "foxglove-layout": foxglove_layout.run,
    "grade": grade.run,
    "replay": replay.run,
    "sweep": sweep.run,
}


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line `argv` (default: that of the process); return the exit code."""
    arguments = list(sys.argv[1:] if argv is None else argv)
    command: Callable[[Sequence[str]], int] = suite.run
    if arguments and arguments[0] in COMMANDS:
        command = COMMANDS[arguments.pop(0)]
    try:
        return command(arguments)
    except BrokenPipeError:  # the reader has closed the pipe, as `head` does
        return 0
    except OSError as error:
        if error.filename != STANDARD_OUTPUT:
            raise
        print(f"thymio-sim: {STANDARD_OUTPUT}: {error.strerror}", file=sys.stderr)
    except UsageError as error:
        print(f"thymio-sim: {error}", file=sys.stderr)
    except KeyboardInterrupt:
        exit_by_signal(signal.SIGINT)
    return USAGE_ERROR
