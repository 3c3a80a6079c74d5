"""The console scripts: each imports its program here, so that Ctrl-C also ends the start without a traceback.

Imports cannot be interrupted by an exception: it may be raised in an extension that turns it into another one, or in a
destructor that prints and drops it. So SIGINT ends the process at once, without Python, until nodes or a batch run
install their own handler (`nodes/life.py`, `interruption.py`): nothing has begun by then that needs an end.
"""

from __future__ import annotations

import os
import signal
import sys
from importlib import import_module
from types import FrameType

__all__ = ["aseba_runtime", "foxglove_bridge", "simulator", "thymio", "thymio_sim", "web_ui"]

INTERRUPTED = 130
"""Exit code of a command that did not come to its end, as shells have it; a node that is ended has done its work."""


def thymio_sim() -> int:
    """The whole suite, or what works without ROS; the exit code, as of all here."""
    return _run("thymio_sim_ros.cli", INTERRUPTED)


def aseba_runtime() -> int:
    """The executable `aseba_runtime`."""
    return _run("thymio_sim_ros.nodes.aseba_node")


def foxglove_bridge() -> int:
    """The executable `foxglove_bridge`."""
    return _run("thymio_sim_ros.nodes.foxglove_node")


def simulator() -> int:
    """The executable `simulator`."""
    return _run("thymio_sim_ros.nodes.simulator_node")


def thymio() -> int:
    """The executable `thymio`: all nodes in one process."""
    return _run("thymio_sim_ros.nodes.all_nodes")


def web_ui() -> int:
    """The executable `web_ui`."""
    return _run("thymio_sim_ros.nodes.web_node")


def _run(program: str, interrupted: int = 0) -> int:
    _open_standard_streams()

    def leave(_number: int, _frame: FrameType | None) -> None:
        os._exit(interrupted)

    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:  # else it is ignored, as in the background
        signal.signal(signal.SIGINT, leave)
    try:
        return int(import_module(program).main())
    except KeyboardInterrupt:
        return interrupted


def _open_standard_streams() -> None:
    """Open those of stdin, stdout and stderr that were closed (`thymio-sim >&-`, some services): to nowhere.

    Python leaves None in their place, and the next file that is opened gets their descriptor.
    """
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            descriptor = os.open(os.devnull, os.O_RDWR)  # the lowest free number: that of the closed stream
            if descriptor != number:
                os.dup2(descriptor, number)
                os.close(descriptor)
            setattr(sys, name, open(number, "r" if number == 0 else "w", encoding="utf-8", closefd=False))
