"""What rclpy and the embedded graph do alike with actions (see scenario.py): goals, their states, results, errors."""

from __future__ import annotations

import json
import sys
from typing import Any

import rclpy
from action_msgs.msg import GoalStatusArray
from action_msgs.srv import CancelGoal
from rclpy.action import (
    ActionClient,
    ActionServer,
    CancelResponse,
    GoalResponse,
    get_action_client_names_and_types_by_node,
    get_action_names_and_types,
    get_action_server_names_and_types_by_node,
)
from rclpy.action.server import GoalEvent
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.clock import ClockType
from rclpy.duration import Duration
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile, qos_profile_action_status_default
from rclpy.time import Time
from rosgraph_msgs.msg import Clock
from scenario import attempt, seen, spin_until
from std_msgs.msg import String
from test_msgs.action import Fibonacci, NestedMessage
from unique_identifier_msgs.msg import UUID


class Course:
    """A server that keeps the handles of all goals, a client, and what happened."""

    def __init__(self, node: Node, executor: Any, name: str, **options: Any) -> None:
        self.executor, self.handles = executor, []
        self.answer = CancelResponse.ACCEPT
        self.asked = 0
        arguments = {"handle_accepted_callback": self.handles.append, "cancel_callback": self.cancel, **options}
        self.server = ActionServer(node, Fibonacci, name, arguments.pop("execute_callback", succeed), **arguments)
        self.client = ActionClient(node, Fibonacci, name)
        spin_until(executor, self.client.server_is_ready)

    def cancel(self, _: Any) -> CancelResponse:
        """Answer as the scenario wants it."""
        self.asked += 1
        return self.answer

    def wait(self, future: Any) -> Any:
        """The result of a future."""
        spin_until(self.executor, future.done)
        return future.result()

    def send(self, order: int = 1, **options: Any) -> Any:
        """The handle that a client gets of a new goal."""
        return self.wait(self.client.send_goal_async(Fibonacci.Goal(order=order), **options))

    def destroy(self) -> None:
        """Remove client and server."""
        self.client.destroy()
        self.server.destroy()


def succeed(goal: Any) -> Fibonacci.Result:
    """Execute a goal: its result is its order."""
    goal.succeed()
    return Fibonacci.Result(sequence=[goal.request.order])


def result_of(course: Course, handle: Any) -> tuple[int, list[int]]:
    """State and numbers of the result of a goal."""
    response = course.wait(handle.get_result_async())
    return response.status, list(response.result.sequence)


def states(node: Node, executor: Any) -> None:
    """The states of goals and the events that change them."""
    course = Course(node, executor, "states")
    accepted = course.send()
    goal = course.handles[0]
    seen["accepted"] = accepted.accepted, goal.status, goal.is_active, goal.is_cancel_requested, goal.request.order
    seen["same id"] = accepted.goal_id == goal.goal_id, attempt(hash, goal), attempt(hash, accepted)
    changes = ("succeed", "abort", "canceled")
    seen["before execution"] = [attempt(getattr(goal, one)) for one in changes], goal.status
    goal.execute()
    seen["executing"] = goal.status, attempt(goal.canceled), attempt(goal.execute)
    seen["succeeded"] = result_of(course, accepted), goal.status, goal.is_active
    seen["at the end"] = [attempt(getattr(goal, one)) for one in (*changes, "execute")]
    seen["feedback of another"] = attempt(goal.publish_feedback, Fibonacci.Goal())
    spin_until(executor, lambda: accepted.status == goal.status)
    canceled = course.send()
    reply = course.wait(canceled.cancel_goal_async())
    goal = course.handles[1]
    seen["canceling"] = reply.return_code, len(reply.goals_canceling), goal.status, goal.is_cancel_requested
    seen["in canceling"] = attempt(goal._update_state, GoalEvent.EXECUTE)
    goal.execute(lambda goal: (goal.canceled(), Fibonacci.Result())[1])
    seen["canceled"] = result_of(course, canceled), goal.status
    course.destroy()
    seen["unknown"] = goal.status, goal.is_active, [attempt(getattr(goal, one)) for one in changes]


def cancellation(node: Node, executor: Any) -> None:
    """Which goals a request to cancel is about, and the return codes."""
    course = Course(node, executor, "canceled")
    client = node.create_client(CancelGoal, "canceled/_action/cancel_goal")
    spin_until(executor, client.service_is_ready)

    def ask(**wanted: Any) -> tuple[int, int, list[int]]:
        request = CancelGoal.Request()
        for name, value in wanted.items():
            setattr(request.goal_info, name, value)
        reply = course.wait(client.call_async(request))
        return reply.return_code, len(reply.goals_canceling), [one.status for one in course.handles]

    seen["no goals"] = ask()
    handles = [course.send() for _ in range(4)]
    course.answer = CancelResponse.REJECT
    seen["rejected"] = ask(goal_id=handles[3].goal_id), course.asked
    course.answer = CancelResponse.ACCEPT
    seen["no such goal"] = ask(goal_id=UUID(uuid=[7] * 16))
    seen["by id"] = ask(goal_id=handles[3].goal_id), ask(goal_id=handles[3].goal_id)
    third = course.handles[2]._goal_info.stamp  # rcl stamps a goal some time later than its handle
    stamp = Time.from_msg(third, clock_type=ClockType.SYSTEM_TIME) - Duration(nanoseconds=1)
    seen["by time"] = ask(stamp=stamp.to_msg())
    seen["all"] = ask(), ask()
    course.destroy()


def callbacks(node: Node, executor: Any) -> None:
    """Callbacks that are coroutines, that fail, or that return what they must not."""
    order: list[str] = []

    async def accept(_: Any) -> GoalResponse:
        order.append("goal")
        return GoalResponse.ACCEPT

    async def run(goal: Any) -> None:
        order.append("accepted")
        goal.execute()

    async def execute(goal: Any) -> Fibonacci.Result:
        order.append("execute")
        goal.publish_feedback(Fibonacci.Feedback(sequence=[goal.request.order]))
        goal.succeed()
        return Fibonacci.Result(sequence=[1, 2])

    async def note(message: Any) -> None:
        order.append(f"feedback {list(message.feedback.sequence)}")

    course = Course(
        node,
        executor,
        "coroutines",
        goal_callback=accept,
        handle_accepted_callback=run,
        execute_callback=execute,
        callback_group=ReentrantCallbackGroup(),
    )
    goal_id = UUID(uuid=[3] * 16)
    handle = course.send(5, feedback_callback=note, goal_uuid=goal_id)
    spin_until(executor, lambda: len(order) == 4)
    seen["coroutines"] = order.copy(), result_of(course, handle), handle.goal_id == goal_id
    seen["same id again"] = course.send(goal_uuid=goal_id).accepted
    course.server.register_goal_callback(lambda _: "yes")
    seen["no response"] = course.send().accepted
    course.server.register_goal_callback(None)
    course.server.register_execute_callback(lambda _: Fibonacci.Result(sequence=[3]))
    seen["no end"] = result_of(course, course.send())
    course.server.register_execute_callback(fail)
    seen["error"] = result_of(course, course.send())
    seen["not callable"] = attempt(course.server.register_execute_callback, None)
    course.destroy()


def fail(_: Any) -> None:
    """Raise an error."""
    raise ZeroDivisionError


def graph(node: Node, executor: Any) -> None:
    """The names of actions and their parts, and what a node lists."""
    course = Course(node, executor, "named")
    nested = ActionClient(node, NestedMessage, "~/nested")
    name, namespace = node.get_name(), node.get_namespace()
    spin_until(executor, lambda: len(get_action_names_and_types(node)) == 2)
    seen["actions"] = get_action_names_and_types(node)
    seen["servers"] = get_action_server_names_and_types_by_node(node, name, namespace)
    seen["clients"] = get_action_client_names_and_types_by_node(node, name, namespace)
    unknown = attempt(get_action_server_names_and_types_by_node, node, "absent", namespace)
    seen["no node"] = unknown.partition(" and type")[0]
    for query in (node.get_topic_names_and_types, node.get_service_names_and_types):
        seen[query.__name__] = [pair for pair in query() if "_action" in pair[0]]
    for query in (
        node.get_publisher_names_and_types_by_node,
        node.get_subscriber_names_and_types_by_node,
        node.get_service_names_and_types_by_node,
        node.get_client_names_and_types_by_node,
    ):
        seen[query.__name__] = [pair for pair in query(name, namespace) if "_action" in pair[0]]
    listed = (node.publishers, node.subscriptions)
    seen["topics of the node"] = [one.topic_name for ends in listed for one in ends if "_action" in one.topic_name]
    services = (node.services, node.clients)
    seen["services of the node"] = [one.srv_name for ends in services for one in ends if "_action" in one.srv_name]
    seen["timers"] = len(list(node.timers))
    waitables = list(node.waitables)
    seen["waitables"] = [any(one is end for one in waitables) for end in (course.server, course.client, nested)]
    seen["numbers"] = repr(course.server.get_num_entities()), repr(course.client.get_num_entities())
    seen["ready"] = course.client.server_is_ready(), nested.server_is_ready(), nested.wait_for_server(0.0)
    seen["wrong names"] = [
        attempt(ActionServer, node, Fibonacci, one, succeed).partition(" : ")[::2][:1] for one in ("a b", "1a", "a/")
    ]
    seen["wrong types"] = attempt(ActionClient, node, str, "a"), attempt(node.create_publisher, Fibonacci, "a", 1)
    seen["wrong goals"] = (
        attempt(course.client.send_goal, "goal"),
        attempt(course.client.send_goal_async, Fibonacci.Result()),
        attempt(course.client._cancel_goal_async, 1),
    )
    seen["negative"] = attempt(ActionServer, node, Fibonacci, "late", succeed, result_timeout=-1.0)
    nested.destroy()
    course.destroy()
    spin_until(executor, lambda: not get_action_names_and_types(node))


def states_published(node: Node, executor: Any) -> None:
    """The topics of an action, as other nodes see them."""
    lists: list[list[int]] = []
    kind = Fibonacci.Impl
    feedback: list[Any] = []
    course = Course(node, executor, "published")

    def note(message: GoalStatusArray) -> None:
        lists.append([one.status for one in message.status_list])

    node.create_subscription(
        kind.GoalStatusMessage, "published/_action/status", note, qos_profile_action_status_default
    )
    node.create_subscription(kind.FeedbackMessage, "published/_action/feedback", feedback.append, QoSProfile(depth=10))
    spin_until(executor, lambda: node.count_subscribers("published/_action/feedback") == 2)
    course.send()
    spin_until(executor, lambda: [1] in lists)
    course.send()
    spin_until(executor, lambda: [1, 1] in lists)
    goal = course.handles[0]
    goal.publish_feedback(Fibonacci.Feedback(sequence=[1, 1]))
    spin_until(executor, lambda: bool(feedback))
    seen["feedback"] = list(feedback[0].feedback.sequence), feedback[0].goal_id == goal.goal_id
    goal.execute(abort)
    spin_until(executor, lambda: [6, 1] in lists)
    seen["states"] = lists[:2]
    late: list[list[int]] = []
    node.create_subscription(
        kind.GoalStatusMessage,
        "published/_action/status",
        lambda message: late.append([one.status for one in message.status_list]),
        qos_profile_action_status_default,
    )
    spin_until(executor, lambda: bool(late))
    seen["late states"] = late
    course.destroy()


def abort(goal: Any) -> Fibonacci.Result:
    """Execute a goal without success."""
    goal.abort()
    return Fibonacci.Result()


def expiry(executor: Any) -> None:
    """Results are kept for a time of the clock of the node, after the end of the goal."""
    node = rclpy.create_node("timed", parameter_overrides=[Parameter("use_sim_time", value=True)])
    executor.add_node(node)
    clock = node.create_publisher(Clock, "/clock", 1)

    def set_clock(seconds: int) -> None:
        message = Clock()
        message.clock.sec = seconds
        for _ in range(1000):
            clock.publish(message)
            executor.spin_once(timeout_sec=0.1)
            if node.get_clock().now().nanoseconds == seconds * 10**9:
                return
        raise AssertionError("the clock was not set")

    set_clock(100)
    course = Course(node, executor, "timed", result_timeout=10.0)
    early, late = course.send(1), course.send(2)
    seen["stamps"] = early.stamp.sec, late.stamp.sec
    first, second = course.handles
    first.execute()
    seen["first"] = result_of(course, early)
    set_clock(108)
    second.execute()
    seen["second"] = result_of(course, late)
    set_clock(130)
    spin_until(executor, lambda: first.status == second.status == 0)
    seen["over"] = result_of(course, early), result_of(course, late), first.is_active, attempt(second.succeed)
    executor.remove_node(node)
    course.destroy()
    node.destroy_node()


def ends(node: Node) -> None:
    """Actions after a shutdown of the context."""
    client = ActionClient(node, Fibonacci, "nowhere")
    server = ActionServer(node, Fibonacci, "somewhere", succeed)
    rclpy.shutdown()
    seen["after the shutdown"] = [
        attempt(client.server_is_ready),
        attempt(client.wait_for_server, 0.1),
        attempt(ActionServer, node, Fibonacci, "late", succeed),
    ]
    server.destroy()
    node.destroy_node()
    seen["after the node"] = attempt(client.server_is_ready), attempt(client.send_goal_async, String())


def main() -> None:
    """Run all parts on an executor and print what was seen."""
    rclpy.init(args=[])
    node = rclpy.create_node("own", namespace="space")
    executor: Any = MultiThreadedExecutor(2) if "multi" in sys.argv else SingleThreadedExecutor()
    executor.add_node(node)
    states(node, executor)
    cancellation(node, executor)
    callbacks(node, executor)
    graph(node, executor)
    states_published(node, executor)
    expiry(executor)
    executor.shutdown()
    ends(node)
    print(json.dumps(seen, indent=1))


if __name__ == "__main__":
    main()
