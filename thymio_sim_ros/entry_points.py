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

__all__ = [
    "aseba_runtime",
    "button_lights",
    "event_answer",
    "foxglove_bridge",
    "go_to_goal_odom",
    "go_to_goal_tf",
    "line_follower",
    "simulator",
    "thymio",
    "thymio_sim",
    "wall_follower",
    "web_ui",
]


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


def button_lights() -> int:
    """The example `button_lights`."""
    return _run_example("button_lights")


def event_answer() -> int:
    """The example `event_answer`."""
    return _run_example("event_answer")


def go_to_goal_odom() -> int:
    """The example `go_to_goal_odom`."""
    return _run_example("go_to_goal_odom")


def go_to_goal_tf() -> int:
    """The example `go_to_goal_tf`."""
    return _run_example("go_to_goal_tf")


def line_follower() -> int:
    """The example `line_follower`."""
    return _run_example("line_follower")


def wall_follower() -> int:
    """The example `wall_follower`."""
    return _run_example("wall_follower")


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


def _run_example(name: str) -> int:
    """Run an example node. Like a student's program, it ends by the exception that Ctrl-C raises.

    Until its imports are done, Ctrl-C ends the process as it does in `_run`.
    """
    is_ours = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if is_ours:
        signal.signal(signal.SIGINT, _leave)
    example = import_module(f"thymio_sim_ros.examples.{name}")
    if is_ours:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    example.main()
    if is_ours:
        signal.signal(signal.SIGINT, _leave)
    return 0
