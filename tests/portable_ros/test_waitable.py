"""Waitables in an executor; rclpy's own are made of parts of its C library, so that these run here only."""

from __future__ import annotations

from typing import Any

import pytest

from thymio_sim_ros.portable_ros.rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from thymio_sim_ros.portable_ros.rclpy.executors import SingleThreadedExecutor
from thymio_sim_ros.portable_ros.rclpy.node import Node
from thymio_sim_ros.portable_ros.rclpy.task import Future
from thymio_sim_ros.portable_ros.rclpy.waitable import EntitySet, NumberOfEntities, Waitable


class Doorbell(Waitable):
    """Counts the triggers of a guard condition that another group blocks."""

    def __init__(self, node: Node) -> None:
        super().__init__(MutuallyExclusiveCallbackGroup())
        blocked = MutuallyExclusiveCallbackGroup()
        self.guard = node.create_guard_condition(print, blocked)
        blocked.beginning_execution(self.guard)
        self.executed: list[str] = []
        self._index = 0

    def add_to_wait_set(self, wait_set: EntitySet) -> None:
        self._index = wait_set.add_guard_condition(self.guard.handle)

    def is_ready(self, wait_set: EntitySet) -> bool:
        return wait_set.is_ready("guard_condition", self._index)

    def take_data(self) -> str:
        self.guard.take()
        return "rung"

    async def execute(self, taken_data: Any) -> None:
        self.executed.append(taken_data)

    def get_num_entities(self) -> NumberOfEntities:
        return NumberOfEntities(num_gcs=1)


def test_a_waitable_is_executed_once_for_each_time_that_it_is_ready(node: Node) -> None:
    bell = Doorbell(node)
    node.add_waitable(bell)
    assert bell in node.waitables
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    executor.spin_once(timeout_sec=0)
    assert bell.executed == []
    bell.guard.trigger()
    for _ in range(3):
        executor.spin_once(timeout_sec=0)
    assert bell.executed == ["rung"]
    node.remove_waitable(bell)
    bell.guard.trigger()
    executor.spin_once(timeout_sec=0)
    assert bell.executed == ["rung"]
    with pytest.raises(ValueError, match="expected a waitable of the node"):
        node.remove_waitable(bell)


def test_the_callbacks_of_a_waitables_futures_run_in_the_executor(node: Node) -> None:
    bell, future, called = Doorbell(node), Future(), []
    future.add_done_callback(called.append)
    bell.add_future(future)
    node.add_waitable(bell)
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    bell.guard.trigger()
    executor.spin_once(timeout_sec=0)
    future.set_result(1)
    assert called == []
    executor.spin_once(timeout_sec=0)
    assert called == [future]


def test_a_timer_is_ready_when_it_is_due(node: Node) -> None:
    waited = EntitySet()
    indices = [waited.add_timer(node.create_timer(period_s, print).handle) for period_s in (0.0, 1000.0)]
    assert [waited.is_ready("timer", one) for one in indices] == [True, False]


def test_only_entities_have_handles_to_wait_for(node: Node) -> None:
    with pytest.raises(ValueError, match="found the handle of a Node, expected one of an entity"):
        EntitySet().add_timer(node.handle)
