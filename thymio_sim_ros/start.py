"""The console scripts: each imports its program here, so that Ctrl-C ends also its start without a traceback.

Once nodes run, signals belong to them (`nodes/life.py`).
"""

from __future__ import annotations

from importlib import import_module

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
    try:
        return int(import_module(program).main())
    except KeyboardInterrupt:
        return interrupted
