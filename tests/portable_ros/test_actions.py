"""Actions on the embedded graph: what rclpy does otherwise, or what no program sees (see scenario_actions.py)."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from tests.patience import PATIENCE_S
from thymio_sim_ros.portable_ros.messages.action_class import action_type
from thymio_sim_ros.portable_ros.messages.message_class import message_type, service_type
from thymio_sim_ros.portable_ros.rclpy.action import ActionClient, ActionServer, CancelResponse
from thymio_sim_ros.portable_ros.rclpy.context import Context
from thymio_sim_ros.portable_ros.rclpy.executors import SingleThreadedExecutor
from thymio_sim_ros.portable_ros.rclpy.impl.rcutils_logger import add_sink, remove_sink
from thymio_sim_ros.portable_ros.rclpy.node import Node
from thymio_sim_ros.portable_ros.rclpy.task import Future
from thymio_sim_ros.portable_ros.rclpy.time import Time
from thymio_sim_ros.portable_ros.rclpy_parts.goal_state import GoalEvent, GoalState, next_state

Fibonacci = action_type("test_msgs/action/Fibonacci")
CancelGoal = service_type("action_msgs/srv/CancelGoal")
Bool = message_type("std_msgs/msg/Bool")
Trigger = service_type("std_srvs/srv/Trigger")


@pytest.fixture
def node() -> Iterator[Node]:
    context = Context()
    context.init([])
    made = Node("actions", context=context, enable_rosout=False, start_parameter_services=False)
    executor = SingleThreadedExecutor(context=context)
    made.executor = executor
    yield made
    made.destroy_node()
    executor.shutdown()
    context.try_shutdown()


def spin_until(node: Node, condition: Callable[[], bool]) -> None:
    executor: Any = node.executor
    for _ in range(1000):
        if condition():
            return
        executor.spin_once(timeout_sec=PATIENCE_S / 100)
    raise AssertionError("the condition did not become true")


def result_of(node: Node, future: Future[Any]) -> Any:
    spin_until(node, future.done)
    return future.result()


def succeed(goal: Any) -> Any:
    goal.succeed()
    return Fibonacci.Result(sequence=[goal.request.order])


def send(node: Node, client: Any, **options: Any) -> Any:
    return result_of(node, client.send_goal_async(Fibonacci.Goal(order=1), **options))


@pytest.mark.parametrize("state", [GoalState.SUCCEEDED, GoalState.CANCELED, GoalState.ABORTED, GoalState.UNKNOWN])
def test_a_goal_at_its_end_has_no_events(state: GoalState) -> None:
    for event in GoalEvent:
        with pytest.raises(RuntimeError, match=f"from state {state.name} with event {event.name}"):
            next_state(state, event)


def test_a_request_to_cancel_all_goals_asks_for_each_of_them(node: Node) -> None:
    # rclpy skips some, since it removes what is rejected from the list that it goes through.
    handles: list[Any] = []
    asked: list[Any] = []

    def reject(goal: Any) -> CancelResponse:
        asked.append(goal)
        return CancelResponse.REJECT

    ActionServer(node, Fibonacci, "a", succeed, handle_accepted_callback=handles.append, cancel_callback=reject)
    client: Any = ActionClient(node, Fibonacci, "a")
    for _ in range(4):
        send(node, client)
    cancel = node.create_client(CancelGoal, "a/_action/cancel_goal")
    response: Any = result_of(node, cancel.call_async(CancelGoal.Request()))
    assert asked == handles
    assert len(response.goals_canceling) == 0


def test_each_result_is_kept_for_its_own_time(node: Node) -> None:
    clock: Any = node.get_clock()
    clock._set_ros_time_is_active(True)
    handles: list[Any] = []
    ActionServer(node, Fibonacci, "a", succeed, handle_accepted_callback=handles.append, result_timeout=10)
    client: Any = ActionClient(node, Fibonacci, "a")
    for end_s in (100, 108):
        send(node, client)
        clock.set_ros_time_override(Time(seconds=end_s))
        handles[-1].execute()
        spin_until(node, lambda: not handles[-1].is_active)
    clock.set_ros_time_override(Time(seconds=111))
    spin_until(node, lambda: handles[0].status == GoalState.UNKNOWN)
    assert handles[1].status == GoalState.SUCCEEDED
    clock.set_ros_time_override(Time(seconds=119))
    spin_until(node, lambda: handles[1].status == GoalState.UNKNOWN)


def test_a_destroyed_action_leaves_nothing_in_node_and_graph(node: Node) -> None:
    graph = node.context.graph
    before = len(node.entities()), len(list(node.all_publishers)), list(node.waitables), dict(graph.topics)
    server: Any = ActionServer(node, Fibonacci, "a", succeed)
    client: Any = ActionClient(node, Fibonacci, "a")
    assert len(node.entities()) > before[0]
    for one in (client, server, client, server):
        one.destroy()
    assert (len(node.entities()), len(list(node.all_publishers)), list(node.waitables), dict(graph.topics)) == before
    assert not any(ends for name, ends in graph.services.items() if "_action" in name)
    assert not any(graph.clients.values())


def test_an_action_that_cannot_be_made_leaves_nothing_either(node: Node) -> None:
    node.create_service(Trigger, "a/_action/get_result", lambda _, response: response)
    before = len(node.entities()), list(node.waitables)
    for kind in (ActionServer, ActionClient):
        arguments: Any = (node, Fibonacci, "a", *([succeed] if kind is ActionServer else []))
        with pytest.raises(RuntimeError, match="has the type std_srvs/srv/Trigger"):
            kind(*arguments)
    assert (len(node.entities()), list(node.waitables)) == before


def test_a_server_that_is_destroyed_while_it_executes_a_goal_drops_its_result(node: Node) -> None:
    ended = []

    def execute(goal: Any) -> Any:
        server.destroy()
        goal.succeed()
        ended.append(goal.status)
        return Fibonacci.Result()

    server: Any = ActionServer(node, Fibonacci, "a", execute)
    client: Any = ActionClient(node, Fibonacci, "a")
    send(node, client)
    spin_until(node, lambda: bool(ended))
    assert ended == [GoalState.UNKNOWN]


@pytest.mark.parametrize("result", [None, "text"])
def test_a_result_of_another_type_is_an_error_that_shows_it(node: Node, result: Any) -> None:
    def execute(goal: Any) -> Any:
        goal.succeed()
        return result

    ActionServer(node, Fibonacci, "a", execute)
    client: Any = ActionClient(node, Fibonacci, "a")
    with pytest.raises(TypeError, match=f"found the result {result!r}, expected .*Fibonacci_Result"):
        send(node, client)


def test_responses_of_a_second_server_are_reported(node: Node) -> None:
    lines: list[str] = []
    name = node.get_logger().name
    for _ in range(2):
        ActionServer(node, Fibonacci, "a", succeed)
    client: Any = ActionClient(node, Fibonacci, "a")

    def note(_: str, _2: int, text: str, *_3: Any) -> None:
        lines.append(text)

    add_sink(f"{name}.action_client", note)
    try:
        send(node, client)
        spin_until(node, lambda: bool(lines))
    finally:
        remove_sink(f"{name}.action_client")
    expected = "Ignoring unexpected goal response. There may be more than one action server for the action 'a'"
    assert lines == [expected]


def test_feedback_ends_with_the_result(node: Node) -> None:
    handles: list[Any] = []
    seen: list[Any] = []
    ActionServer(node, Fibonacci, "a", succeed, handle_accepted_callback=handles.append)
    client: Any = ActionClient(node, Fibonacci, "a")
    goal = send(node, client, feedback_callback=seen.append)
    handles[0].publish_feedback(Fibonacci.Feedback())
    spin_until(node, lambda: len(seen) == 1)
    handles[0].execute()
    result_of(node, goal.get_result_async())
    assert not client._feedback_callbacks


def test_the_blocking_calls_wait_for_another_thread(node: Node) -> None:
    ActionServer(node, Fibonacci, "a", succeed, cancel_callback=lambda _: CancelResponse.ACCEPT)
    client: Any = ActionClient(node, Fibonacci, "a")
    found: list[Any] = []

    def call() -> None:
        found.append(client.send_goal(Fibonacci.Goal(order=8)))
        found.append(client.send_goal_async(Fibonacci.Goal()))

    caller = threading.Thread(target=call)
    caller.start()
    spin_until(node, lambda: len(found) == 2)
    caller.join(PATIENCE_S)
    assert list(found[0].result.sequence) == [8]
    goal = result_of(node, found[1])
    caller = threading.Thread(target=lambda: found.append(goal.cancel_goal()))
    caller.start()
    spin_until(node, lambda: len(found) == 3)
    caller.join(PATIENCE_S)
    assert found[2].return_code == CancelGoal.Response.ERROR_GOAL_TERMINATED


def test_what_a_service_publishes_while_it_answers_comes_before_the_response(node: Node) -> None:
    order: list[str] = []
    publisher = node.create_publisher(Bool, "news", 1)

    def answer(_: Any, response: Any) -> Any:
        executor: Any = node.executor
        executor.create_task(publisher.publish, Bool())
        return response

    node.create_subscription(Bool, "news", lambda _: order.append("message"), 1)
    node.create_service(Trigger, "ask", answer)
    future = node.create_client(Trigger, "ask").call_async(Trigger.Request())
    future.add_done_callback(lambda _: order.append("response"))
    spin_until(node, lambda: len(order) == 2)
    assert order == ["message", "response"]


def test_asyncio_waits_for_a_future_of_the_graph(node: Node) -> None:
    ActionServer(node, Fibonacci, "a", succeed)
    client: Any = ActionClient(node, Fibonacci, "a")

    async def spin() -> None:
        executor: Any = node.executor
        while True:
            executor.spin_once(timeout_sec=0)
            await asyncio.sleep(0)

    async def ask() -> Any:
        spinning = asyncio.create_task(spin())
        goal = await client.send_goal_async(Fibonacci.Goal(order=4))
        response = await goal.get_result_async()
        spinning.cancel()
        return list(response.result.sequence)

    assert asyncio.run(ask()) == [4]
