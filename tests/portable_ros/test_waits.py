"""Waits of the embedded graph, by name, and those that cannot end."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

from thymio_sim_ros.portable_ros.graph import waits
from thymio_sim_ros.portable_ros.messages.message_class import service_type
from thymio_sim_ros.portable_ros.rclpy.callback_groups import ReentrantCallbackGroup
from thymio_sim_ros.portable_ros.rclpy.duration import Duration
from thymio_sim_ros.portable_ros.rclpy.executors import Executor, MultiThreadedExecutor, SingleThreadedExecutor
from thymio_sim_ros.portable_ros.rclpy.node import Node

TRIGGER = service_type("std_srvs/srv/Trigger")


class RefusedError(Exception):
    """Ends a wait."""


class Refusing:
    """Notes each wait, and refuses those that would block a test."""

    def __init__(self) -> None:
        self.noted: list[waits.Wait] = []

    def begin(self, wait: waits.Wait) -> None:
        self.noted.append(wait)
        if wait.what != "messages or timers":
            raise RefusedError

    def end(self, wait: waits.Wait) -> None:
        """Need nothing."""


@pytest.fixture
def watcher() -> Iterator[Refusing]:
    made = Refusing()
    before = waits.watch(made)
    yield made
    waits.watch(before)


@pytest.mark.parametrize(
    ("begin", "what", "timeout_s"),
    [
        (lambda node: node.create_client(TRIGGER, "stop").call(TRIGGER.Request()), "the response of /stop", None),
        (lambda node: node.create_client(TRIGGER, "stop").wait_for_service(2.0), "service /stop", 2.0),
        (lambda node: node.wait_for_node("other", 3.0), "node /other", 3.0),
        (lambda node: node.create_rate(10).sleep(), "the next period of a rate", None),
        (lambda node: node.get_clock().sleep_for(Duration(seconds=60), node.context), "time", pytest.approx(60, abs=1)),
    ],
)
def test_a_wait_has_a_name_and_its_limit(
    node: Node, watcher: Refusing, begin: Callable[[Node], object], what: str, timeout_s: float | None
) -> None:
    with pytest.raises(RefusedError):
        begin(node)
    assert [(wait.what, wait.timeout_s) for wait in watcher.noted] == [(what, timeout_s)]


@pytest.mark.parametrize(
    ("executor_class", "group", "is_deadlock"),
    [
        (SingleThreadedExecutor, None, True),
        (SingleThreadedExecutor, ReentrantCallbackGroup(), True),
        (MultiThreadedExecutor, None, True),
        (MultiThreadedExecutor, ReentrantCallbackGroup(), False),
    ],
)
def test_a_call_in_a_callback_is_a_deadlock_unless_another_thread_may_take_the_response(
    node: Node, watcher: Refusing, executor_class: type[Executor], group: ReentrantCallbackGroup, is_deadlock: bool
) -> None:
    client = node.create_client(TRIGGER, "stop", callback_group=group)
    guard = node.create_guard_condition(lambda: client.call(TRIGGER.Request()), callback_group=group)
    executor = executor_class(context=node.context)
    executor.add_node(node)
    guard.trigger()
    with pytest.raises(RefusedError):
        executor.spin()
    found = [wait for wait in watcher.noted if wait.what == "the response of /stop"]
    assert [wait.is_deadlock for wait in found] == [is_deadlock]
    assert ("deadlock" in str(found[0])) is is_deadlock
    executor.shutdown()


def test_a_call_outside_of_callbacks_is_none(node: Node, watcher: Refusing) -> None:
    SingleThreadedExecutor(context=node.context).add_node(node)
    with pytest.raises(RefusedError):
        node.create_client(TRIGGER, "stop").call(TRIGGER.Request())
    assert not watcher.noted[0].is_deadlock
