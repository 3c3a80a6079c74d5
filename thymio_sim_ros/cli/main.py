"""The command `thymio-sim`: selects the subcommand, and turns its errors into one line on stderr and an exit code.

All input is checked before anything starts.
"""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module

from aseba_vm.cli.output import STANDARD_OUTPUT, exit_by_signal
from thymio_sim_ros.cli.errors import USAGE_ERROR, UsageError

__all__ = ["main"]

ROS_TOOLS = "ros.tools"
"""The module of several subcommands, which gets their name."""
COMMANDS: Mapping[str, str] = {
    "runner": "runner",
    "class": "classroom",
    "convert": "convert",
    "doctor": "ros.doctor",
    "env": "ros.env",
    "foxglove-layout": "foxglove_layout",
    "grade": "grade",
    "mission": "mission",
    "node": "ros.node",
    "replay": "replay",
    "ros2": "ros.ros2",
    "sweep": "sweep",
    **dict.fromkeys(("action", "interface", "param", "play", "record", "service", "topic"), ROS_TOOLS),
}
"""The module of each subcommand. Only that of the chosen one is imported, which makes the start of the suite faster."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line `argv` (default: that of the process); return the exit code."""
    arguments = list(sys.argv[1:] if argv is None else argv)
    module = "suite"
    if arguments and arguments[0] in COMMANDS:
        module = COMMANDS[arguments[0]]
        if module != ROS_TOOLS:
            del arguments[0]
    command: Callable[[Sequence[str]], int] = import_module(f"thymio_sim_ros.cli.{module}").run
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
