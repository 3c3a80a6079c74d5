"""Rounds of an executor that does not wait, as the fixtures for nodes use them."""

from __future__ import annotations

import threading
from typing import Any

import pytest

from tests.patience import PATIENCE_S, until
from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.rclpy.callback_groups import ReentrantCallbackGroup
from thymio_sim_ros.portable_ros.rclpy.exceptions import ROSInterruptException
from thymio_sim_ros.portable_ros.rclpy.executors import (
    MultiThreadedExecutor,
    SingleThreadedExecutor,
    TimeoutException,
)
from thymio_sim_ros.portable_ros.rclpy.experimental.events_executor import EventsExecutor
from thymio_sim_ros.portable_ros.rclpy.node import Node
from thymio_sim_ros.portable_ros.rclpy.task import Future


def round_of(executor: SingleThreadedExecutor) -> list[Any]:
    """Run what is ready; returns its entities."""
    entities = []
    while True:
        try:
            task, entity, _ = executor.wait_for_ready_callbacks(timeout_sec=0)
        except TimeoutException:
            return entities
        entities.append(entity)
        task()


def test_an_events_executor_runs_a_task_after_what_was_ready_before(node: Node) -> None:
    called: list[str] = []
    guard = node.create_guard_condition(lambda: called.append("guard"))
    executor = EventsExecutor(context=node.context)
    executor.add_node(node)
    guard.trigger()
    executor.create_task(called.append, "task")
    for _ in range(2):
        executor.spin_once(timeout_sec=0)
    assert called == ["guard", "task"]


def test_a_round_has_what_was_ready_at_its_start_each_entity_once(node: Node) -> None:
    called: list[str] = []

    def ring() -> None:
        called.append("first")
        first.trigger()

    first = node.create_guard_condition(ring)
    second = node.create_guard_condition(lambda: called.append("second"))
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    first.trigger()
    second.trigger()
    assert round_of(executor) == [first, second]
    assert round_of(executor) == [first], "what a callback makes ready belongs to the next round"
    assert called == ["first", "second", "first"]
    assert executor.shutdown(timeout_sec=0), "nothing is running"


def test_a_task_that_is_cancelled_before_its_turn_does_not_hold_the_executor(node: Node) -> None:
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    task = executor.create_task(lambda: pytest.fail("it was cancelled"))
    task.cancel()
    assert round_of(executor) == [None]
    assert executor.shutdown(timeout_sec=0)


def test_a_task_that_creates_another_one_each_time_does_not_stop_entities(node: Node) -> None:
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    called: list[str] = []

    def again() -> None:
        executor.create_task(again)

    executor.create_task(again)
    guard = node.create_guard_condition(lambda: called.append("guard"))
    for _ in range(3):
        guard.trigger()
        for _ in range(4):
            executor.spin_once(timeout_sec=0)
    assert called == ["guard"] * 3


def test_a_spin_for_a_future_without_time_runs_a_callback_that_is_ready(node: Node) -> None:
    executor = SingleThreadedExecutor(context=node.context)
    first, second = (executor.create_task(lambda value=value: value) for value in (1, 2))
    executor.spin_until_future_complete(Future(), timeout_sec=0)
    assert [first.result(), second.result()] == [None, 2], "one callback, the one of the newest task"


def test_a_period_without_sleepers_counts_for_the_next_one_and_the_end_of_the_context_wakes_all(node: Node) -> None:
    rate = node.create_rate(1000.0)
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    executor.spin_once()  # the timer
    rate.sleep()  # no executor spins: it would wait for ever
    ended = []

    def sleep() -> None:
        with pytest.raises(ROSInterruptException):
            rate.sleep()
        ended.append(True)

    sleepers = [threading.Thread(target=sleep) for _ in range(2)]
    for sleeper in sleepers:
        sleeper.start()
    node.context.shutdown()
    for sleeper in sleepers:
        sleeper.join(PATIENCE_S)
    assert ended == [True, True]


class StandIn:
    """An object that has the attributes of a node, as the tools of ros2cli use it."""

    def __init__(self, node: Node) -> None:
        self._node = node

    def __getattr__(self, name: str) -> Any:
        return getattr(self._node, name)


def test_an_object_that_stands_for_a_node_is_executed(node: Node) -> None:
    called: list[str] = []
    guard = node.create_guard_condition(lambda: called.append("rung"))
    executor: Any = SingleThreadedExecutor(context=node.context)
    assert executor.add_node(StandIn(node))
    assert not executor.add_node(node)
    guard.trigger()
    executor.spin_once(timeout_sec=PATIENCE_S)
    assert called == ["rung"]
    executor.remove_node(StandIn(node))
    assert executor.get_nodes() == []


def test_messages_wait_in_their_subscription_while_all_threads_are_busy(node: Node) -> None:
    received: list[int] = []
    is_released = threading.Event()

    def take(message: Any) -> None:
        received.append(message.level)
        is_released.wait(PATIENCE_S)

    publisher = node.create_publisher(ros_types.Log, "busy", 1)
    node.create_subscription(ros_types.Log, "busy", take, 1, callback_group=ReentrantCallbackGroup())
    executor = MultiThreadedExecutor(2, context=node.context)
    executor.add_node(node)
    for level in range(1, 6):
        publisher.publish(ros_types.Log(level=level))
        executor.spin_once(timeout_sec=0)
    is_released.set()
    until(lambda: (executor.spin_once(timeout_sec=0.01), received[-1:] == [5])[1], lambda: received)
    assert sorted(received) == [1, 2, 5], "the subscription keeps one message"
    assert executor.shutdown()
