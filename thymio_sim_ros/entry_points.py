"""The console scripts: each imports its program here, so that Ctrl-C also ends the start without a traceback.

Imports cannot be interrupted by an exception: it may be raised in an extension that converts it to another one, or in a
destructor that prints and drops it. Therefore SIGINT ends the process at once until nodes or a headless run install
their handler (`ros/rclpy_ext/node_runner.py`, `cli/signal_handling.py`): until then nothing needs to be closed.
"""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from importlib import import_module
from types import FrameType

__all__ = ["aseba_runtime", "foxglove_bridge", "simulator", "thymio", "thymio_sim", "web_ui"]


def thymio_sim() -> int:
    """The command `thymio-sim`. Returns the exit code, as all functions here."""
    return _run("thymio_sim_ros.cli.main", signal.SIG_DFL)


def aseba_runtime() -> int:
    """The executable `aseba_runtime`."""
    return _run("thymio_sim_ros.ros.aseba.node")


def foxglove_bridge() -> int:
    """The executable `foxglove_bridge`."""
    return _run("thymio_sim_ros.ros.foxglove.node")


def simulator() -> int:
    """The executable `simulator`."""
    return _run("thymio_sim_ros.ros.simulator.node")


def thymio() -> int:
    """The executable `thymio`: all nodes in one process."""
    return _run("thymio_sim_ros.ros.combined")


def web_ui() -> int:
    """The executable `web_ui`."""
    return _run("thymio_sim_ros.ros.web.node")


def _leave(_number: int, _frame: FrameType | None) -> None:
    """End the process with exit code 0: an interrupted node has no result to report."""
    os._exit(0)


def _run(program: str, on_interrupt: Callable[[int, FrameType | None], None] | signal.Handlers = _leave) -> int:
    """Run the `main` of a module; return its exit code.

    The handler stays installed, because the end of the interpreter cannot be interrupted safely either. With the
    default handler (`SIG_DFL`) the process is ended by the signal, so that the loop of a shell ends too.
    """
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:  # otherwise it is ignored, as in the background
        signal.signal(signal.SIGINT, on_interrupt)
    import_module("aseba_vm.cli.output").open_standard_streams()
    return int(import_module(program).main())
