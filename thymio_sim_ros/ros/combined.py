"""All nodes in one process, each with its own executor and thread: `ros2 run thymio_sim_ros thymio`.

The nodes are the same as in separate processes and communicate by the same topics.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from rclpy.context import Context

from thymio_sim_ros.ros.aseba.node import AsebaRuntime
from thymio_sim_ros.ros.combined_parameters import BRIDGE, PAGE, RUNTIME, SIMULATOR, SUITE, assigned, defaults
from thymio_sim_ros.ros.rclpy_ext.node_runner import AnnouncedNode, RunnableNode, StartError, announce, run_main
from thymio_sim_ros.ros.simulator.node import Simulator
from thymio_sim_ros.suite_config import SuiteConfig

REFUSED = 2
"""Exit code for invalid arguments."""


def suite_nodes(context: Context, suite: SuiteConfig, warnings: Sequence[str] = ()) -> Iterator[AnnouncedNode]:
    """Create simulator, Aseba runtime and, depending on the suite, bridge and page, in this order.

    `warnings` about the arguments are logged by the simulator. Raises StartError if a node cannot start.
    """
    given = defaults(suite)
    simulator = Simulator(context, given[SIMULATOR])
    for warning in warnings:
        simulator.node.get_logger().warning(warning)
    robots = [names.name for names in simulator.endpoints.robots.names.values()]
    yield simulator
    yield AsebaRuntime(context, replace(given[RUNTIME], robots=robots), use_sim_time=True)
    foxglove_port, tokens = suite.foxglove_port, suite.tokens
    if suite.foxglove:
        from thymio_sim_ros.ros.foxglove.node import FoxgloveBridge

        bridge = FoxgloveBridge(context=context, defaults=given[BRIDGE], use_sim_time=True, tokens=tokens)
        yield bridge
        foxglove_port, tokens = bridge.port, bridge.tokens
    if suite.web:
        from thymio_sim_ros.ros.web.node import WebPage

        yield WebPage(context, replace(given[PAGE], foxglove_port=foxglove_port), tokens)


def run(suite: SuiteConfig, args: Sequence[str] | None = None, *, on_ready: Callable[[], None] = lambda: None) -> int:
    """Run the suite until SIGINT or SIGTERM; return the exit code. `args` are ROS arguments (None: of the process)."""
    return _run(suite, args, lambda nodes: nodes, on_ready)


def main(args: Sequence[str] | None = None) -> int:
    """The executable `thymio`: the suite with its default values, which ROS arguments can change."""
    return _run(SuiteConfig(), args, announce)


def _run(
    suite: SuiteConfig,
    args: Sequence[str] | None,
    wrap: Callable[[Iterator[AnnouncedNode]], Iterator[RunnableNode]],
    on_ready: Callable[[], None] = lambda: None,
) -> int:
    try:
        with assigned(sys.argv[1:] if args is None else args) as (words, warnings):
            return run_main(
                lambda context: wrap(suite_nodes(context, suite, warnings)), words, executable=SUITE, on_ready=on_ready
            )
    except StartError as error:
        print(f"thymio-sim: {error}", file=sys.stderr)
        return REFUSED
