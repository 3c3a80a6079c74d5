"""All nodes in one process, each with its own executor and thread: `ros2 run thymio_sim_ros thymio`.

The nodes are the same as in separate processes and have the same topics. With Fast DDS the endpoints of the four nodes
do not match each other (`compat/dds_profile.py`): subscriptions of the bridge belong to peers (`rclpy_ext/peers.py`).
Simulator and Aseba runtime share one thread and one engine.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing

import rclpy
from rclpy.context import Context
from rclpy.logging import get_logger
from rclpy.node import Node

from thymio_sim_ros.ros.aseba.node import AsebaRuntime
from thymio_sim_ros.ros.combined_parameters import BRIDGE, PAGE, RUNTIME, SIMULATOR, SUITE, assigned, defaults
from thymio_sim_ros.ros.compat import dds_profile
from thymio_sim_ros.ros.profiles import Profile, named
from thymio_sim_ros.ros.rclpy_ext.node_runner import (
    SPIN_SLICE_S,
    AnnouncedNode,
    NodeRunner,
    RunnableNode,
    StartError,
    announce,
    run_main,
)
from thymio_sim_ros.ros.rclpy_ext.peers import PUBLISHING_PEER, SUBSCRIBING_PEER, PeerContext
from thymio_sim_ros.ros.simulator.node import Simulator
from thymio_sim_ros.suite_config import SuiteConfig
from thymio_sim_ros.web.thread import ServerThread

REFUSED = 2
"""Exit code for invalid arguments."""

HEADLESS = "--headless"
"""Argument of `thymio`, the same as that of `thymio-sim`."""


class SuitePeers:
    """The participants by which the nodes of a suite reach each other.

    The publishers of the bridge's clients have one of their own, so that its subscriptions match them.
    """

    def __init__(self, args: Sequence[str]) -> None:
        """`args`: the ROS arguments of the process."""
        self._receiving, self._sending = PeerContext(args), PeerContext(args)

    def of_bridge(self) -> tuple[Node, Node]:
        """Create the nodes that subscribe and publish for the clients of the bridge."""
        return self._receiving.node(SUBSCRIBING_PEER), self._sending.node(PUBLISHING_PEER)

    def close(self) -> None:
        """Destroy all peers."""
        self._receiving.close()
        self._sending.close()


def suite_nodes(
    context: Context, suite: SuiteConfig, warnings: Sequence[str] = (), peers: SuitePeers | None = None
) -> Iterator[AnnouncedNode]:
    """Create simulator, Aseba runtime and, depending on the suite, bridge and page, in this order.

    With a real robot there is no simulator, and no simulated time. `warnings` about the arguments are logged by the
    first node. `peers` are needed if the endpoints of `context` do not match each other. Raises StartError if a node
    cannot start.
    """
    # One thread for all servers, so that the page's port has everything; it ends with the last node that uses it.
    thread = ServerThread(warn=get_logger("thymio").warning) if suite.web else None
    try:
        yield from _nodes(context, suite, warnings, peers, thread)
    finally:
        if thread is not None:
            thread.close()


def _nodes(
    context: Context,
    suite: SuiteConfig,
    warnings: Sequence[str],
    peers: SuitePeers | None,
    thread: ServerThread | None,
) -> Iterator[AnnouncedNode]:
    given = defaults(suite)
    tokens, access = suite.tokens, None
    is_simulated = not suite.robot
    if is_simulated:
        simulator = Simulator(context, given[SIMULATOR], profile=_profile(suite))
        _log(simulator.node, warnings)
        try:
            runtime = AsebaRuntime(context, given[RUNTIME], simulator=simulator, tokens=tokens, thread=thread)
            simulator.attached = (runtime,)
        except StartError:
            simulator.close()
            raise
        yield simulator
    else:
        runtime = AsebaRuntime(context, given[RUNTIME], use_sim_time=False, tokens=tokens, thread=thread)
        _log(runtime.node, warnings)
        yield runtime
    if suite.foxglove:
        from thymio_sim_ros.ros.foxglove.node import FoxgloveBridge

        bridge = FoxgloveBridge(
            context=context,
            defaults=given[BRIDGE],
            use_sim_time=is_simulated,
            tokens=tokens,
            peers=None if peers is None else peers.of_bridge(),
            page_thread=thread,
        )
        yield bridge
        tokens, access = bridge.tokens, bridge.access_check
    if suite.web:
        from thymio_sim_ros.ros.web.node import WebPage

        yield WebPage(context, given[PAGE], tokens, thread, access)


def _profile(suite: SuiteConfig) -> Profile | None:
    return named(suite.like) if suite.like else None


def _log(node: Node, warnings: Sequence[str]) -> None:
    for warning in warnings:
        node.get_logger().warning(warning)


def run(suite: SuiteConfig, args: Sequence[str] | None = None, *, on_ready: Callable[[], None] = lambda: None) -> int:
    """Run the suite until SIGINT or SIGTERM; return the exit code. `args` are ROS arguments (None: of the process)."""
    return _run(suite, args, lambda nodes: nodes, on_ready)


def run_ticks(suite: SuiteConfig, ticks: int) -> None:
    """Run the suite until its world has made so many ticks, and end it; no thread remains. Raises StartError."""
    context = Context()
    rclpy.init(context=context, args=[])
    runner = NodeRunner(context)
    try:
        nodes = list(suite_nodes(context, suite))
        for node in nodes:
            runner.start(node)
        simulator = nodes[0]
        assert isinstance(simulator, Simulator)
        while simulator.runner.engine.tick < ticks and runner.failure is None:
            time.sleep(SPIN_SLICE_S)
    finally:
        runner.close()
        rclpy.shutdown(context=context)


def main(args: Sequence[str] | None = None) -> int:
    """The executable `thymio`: the suite with its default values, which ROS arguments can change.

    With `--headless` before them it has no bridge and no page.
    """
    words = sys.argv[1:] if args is None else list(args)
    is_shown = not (words and words[0] == HEADLESS)
    return _run(SuiteConfig(foxglove=is_shown, web=is_shown), words[not is_shown :], announce)


def _run(
    suite: SuiteConfig,
    args: Sequence[str] | None,
    wrap: Callable[[Iterator[AnnouncedNode]], Iterator[RunnableNode]],
    on_ready: Callable[[], None] = lambda: None,
) -> int:
    try:
        with (
            assigned(sys.argv[1:] if args is None else args, _profile(suite)) as (words, warnings),
            dds_profile.used(dds_profile.ALONE) as is_alone,
            closing(SuitePeers(words)) as peers,
        ):
            return run_main(
                lambda context: wrap(suite_nodes(context, suite, warnings, peers if is_alone else None)),
                words,
                executable=SUITE,
                on_ready=on_ready,
            )
    except StartError as error:
        print(f"thymio-sim: {error}", file=sys.stderr)
        return REFUSED
