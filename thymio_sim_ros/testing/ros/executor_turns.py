"""ExecutorTurns of a node under test, on rclpy's standard executor: the one that `rclpy.spin(node)` gives it elsewhere.

The events executor is quicker, but runs no callbacks that are coroutines, and calls timers of simulated time when they
are not due (measured with rclpy 7.1.5: one of 30 ms beside one of 50 ms twice at 60 ms and not at 90 ms; which of two
that are due together comes first differs from run to run).
"""

from __future__ import annotations

from functools import partial
from typing import Any

from rclpy.context import Context
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor, TimeoutException
from rclpy.node import Node
from rclpy.timer import Timer

from thymio_sim_ros.testing.ros.containment import Containment
from thymio_sim_ros.testing.ros.cpu_limit import CPU_LIMIT_S

__all__ = ["ExecutorTurns"]

MAX_ROUNDS = 10
"""Messages of one topic that a node may handle in one turn; more wait for its next, so that time passes anyway."""


class ExecutorTurns:
    """The executor of one node. Each node has its own, so that nodes run in the order in which they were started."""

    def __init__(self, node: Node, context: Context, containment: Containment, cpu_limit: float = CPU_LIMIT_S) -> None:
        """`cpu_limit`: processor time in s that a callback may use; more fails the test."""
        self._containment = containment
        self._node = node
        self._cpu_limit = cpu_limit
        self._executor = SingleThreadedExecutor(context=context)
        self._executor.add_node(node)

    def run(self) -> None:
        """Handle all waiting messages and timers without blocking; exceptions of callbacks are raised here."""
        for _ in range(MAX_ROUNDS):
            may_be_more = self._round()
            if not may_be_more and not any(timer.is_ready() for timer in self._node.timers):
                return

    def _round(self) -> bool:
        """Handle one message of each topic and all timers that are due; whether there may be more than that.

        A round costs a third of a millisecond even if nothing is there: none follows timers or /clock alone.
        """
        may_be_more = False
        entity: Any
        while True:
            if not self._executor.context.ok():
                raise ExternalShutdownException
            try:
                handler, entity, _ = self._executor.wait_for_ready_callbacks(timeout_sec=0)
            except TimeoutException:
                return may_be_more
            may_be_more |= not isinstance(entity, Timer) and getattr(entity, "topic_name", "") != "/clock"
            describe = partial(self._describe, entity)
            with self._containment.contain(describe, self._cpu_limit):
                handler()
                handler.result()  # raises what the callback has raised

    def _describe(self, entity: object) -> str:
        """The callback of an entity."""
        name = getattr(entity, "topic_name", "") or getattr(entity, "srv_name", "")
        what = "a timer" if isinstance(entity, Timer) else name or "a task"
        return f"the callback of node {self._node.get_name()} for {what}"

    def shutdown(self) -> None:
        """Shut the executor down without waiting for unfinished callbacks of the node."""
        self._executor.remove_node(self._node)
        self._executor.shutdown(timeout_sec=0)
