"""More of what rclpy and the embedded graph do alike (see scenario.py): logs, futures, events, parameters of others."""

from __future__ import annotations

import asyncio
import json
import sys
import warnings
from typing import Any

import rclpy
import rclpy.logging
from rcl_interfaces.msg import LoggerLevel, ParameterDescriptor
from rcl_interfaces.srv import GetLoggerLevels, SetLoggerLevels
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.clock import Clock, ROSClock
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.expand_topic_name import expand_topic_name
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.logging import LoggingSeverity
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.parameter_client import AsyncParameterClient
from rclpy.parameter_event_handler import ParameterEventHandler
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSPolicyKind, QoSProfile
from rclpy.qos_overriding_options import QoSOverridingOptions
from rclpy.task import Future, Task
from rclpy.time import Time
from rclpy.time_source import TimeSource
from rclpy.topic_endpoint_info import TopicEndpointInfo
from rclpy.type_hash import TypeHash
from rclpy.waitable import NumberOfEntities
from scenario import attempt, seen, spin_until
from std_msgs.msg import String
from std_srvs.srv import Trigger


def ignore(_: Any) -> None:
    """Do nothing for a message or an event."""


def logs() -> None:
    """Levels and filters of logs."""
    rclpy.logging.set_logger_level("", LoggingSeverity.UNSET)
    levels = [rclpy.logging.get_logger_effective_level("a.b")]
    rclpy.logging.clear_config()
    levels += [rclpy.logging.get_logger_level(""), rclpy.logging.get_logger_effective_level("a.b")]
    seen["levels"] = [level.name for level in levels]
    log = rclpy.logging.get_logger("logs")
    clock = ROSClock()
    clock._set_ros_time_is_active(True)

    def throttled(second: int) -> bool:
        clock.set_ros_time_override(Time(seconds=second))
        return log.info("throttled", throttle_duration_sec=2, throttle_time_source_type=clock)

    def skipped() -> bool:
        return log.info("skipped", skip_first=True, once=True)

    def plain(**options: Any) -> bool:
        return log.info("plain", **options)

    seen["passed"] = [throttled(one) for one in range(5)], [skipped() for _ in range(4)]
    seen["changed"] = [
        attempt(plain),
        attempt(plain, name="other"),
        attempt(plain, once=True),
        attempt(log.info, "", throttle_duration_sec=1, throttle_time_source_type="clock"),
    ]
    seen["options"] = [
        attempt(log.info, "", throttle_time_source_type=Clock()).partition(" for the")[0],
        attempt(log.info, "", throttle=1).partition(' "[')[0],
        attempt(log.debug, "", throttle=1),
        attempt(log.get_child, ""),
    ]


def futures() -> None:
    """Cancellation, callbacks and their errors, coroutines that a program runs on its own."""
    future = Future()
    called: list[str] = []
    future.add_done_callback(lambda _: called.append("cancelled"))
    future.cancel()
    seen["cancelled"] = future.done(), future.cancelled(), attempt(future.result), called
    done = Future()
    done.set_result(1)
    seen["late callback"] = attempt(done.add_done_callback, lambda _: 1 // 0)
    failed = Future()
    failed.set_exception(ValueError("no"))
    seen["failed"] = failed.done(), attempt(failed.result)

    class Bare:
        """An executor with nothing but `create_task`."""

        def __init__(self) -> None:
            self.tasks: list[Any] = []

        def create_task(self, *words: Any) -> None:
            self.tasks.append(words)

    async def wait() -> str:
        await asyncio.sleep(0)
        return "result"

    bare = Bare()
    task = Task(wait, executor=bare)
    task.add_done_callback(called.append)
    states = [task.done()]
    for _ in range(2):
        task()
        states.append(task.done())
    seen["task"] = states, task.result(), len(bare.tasks)


def records() -> None:
    """Facts about endpoints, hashes and profiles: what they show and refuse."""
    info = TopicEndpointInfo()
    changes: Any = (
        ("node_name", 1),
        ("topic_type_hash", {"version": 1, "value": bytes(32)}),
        ("topic_type_hash", 1),
        ("endpoint_type", 2),
        ("endpoint_type", 9),
        ("endpoint_gid", ["a"]),
        ("endpoint_gid", [1, 2]),
        ("qos_profile", {"history": 1, "depth": 3}),
        ("qos_profile", 1),
    )
    seen["changes of a record"] = [attempt(setattr, info, *one).partition(": ")[::2][:1] for one in changes]
    seen["record"] = str(info), str(TopicEndpointInfo()), info == TopicEndpointInfo(), str(TypeHash(1, b"1"))
    seen["unknown field"] = attempt(TopicEndpointInfo, foo=1).partition(": ")[0]
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        profile = QoSProfile(depth=0)
        profile.depth = 1
        profile.depth = 0
        MultiThreadedExecutor(1, context=rclpy.get_default_context()).shutdown()
    seen["warnings"] = [str(one.message) for one in caught]
    wrong: Any = ({"history": 7}, {"history": "x"}, {"depth": 1, "deadline": 1}, {"foo": 1})
    seen["wrong profiles"] = [attempt(QoSProfile, **one).partition(": ")[0] for one in wrong]
    context = rclpy.Context()
    with context:
        seen["twice"] = context.ok(), attempt(context.__enter__)
    seen["shut down"] = context.ok(), attempt(context.shutdown), attempt(rclpy.Context().shutdown)


def tasks(executor: Any) -> None:
    """The order of tasks, and coroutines that wait for others."""
    order: list[str] = []

    async def first() -> str:
        order.append("first")
        return "result"

    async def second() -> str:
        order.append("second waits")
        found: str = await waited
        order.append("second proceeds")
        return found

    waited = executor.create_task(first)
    waiting = executor.create_task(second)
    for _ in range(3):
        executor.spin_once(timeout_sec=1)
    seen["tasks"] = order, waiting.done(), waiting.result()
    future = Future(executor=executor)
    called: list[int] = []
    for number in range(3):
        future.add_done_callback(lambda _, number=number: called.append(number))
    future.set_result(None)
    spin_until(executor, lambda: len(called) == 3)
    seen["done callbacks"] = called


def names_of_node(node: Node) -> None:
    """Wrong names in queries, and names before and after expansion."""
    wrong = ("42", "a b", "", "a{b", "{x}")
    seen["expansion"] = [attempt(expand_topic_name, one, "n", "/") for one in wrong]
    seen["wrong nodes"] = [attempt(expand_topic_name, "a", *one) for one in (("n n", "/"), ("n", "s"), ("", "/"))]
    queries = (node.count_publishers, node.count_services, node.get_subscriptions_info_by_topic)
    seen["queries"] = [attempt(query, one) for query in queries for one in wrong]
    seen["no names"] = [attempt(query, 1).partition(":")[0] for query in queries]
    subscription = node.create_subscription(String, "given", ignore, 1)
    client = node.create_client(Trigger, "asked")
    seen["names"] = subscription.topic, subscription.topic_name, client.srv_name, client.service_name
    prefixes: Any = (([], -1), ([], 1.5), ("ab", 0), ([1], 0), (["no"], 0))
    seen["prefixes"] = [attempt(node.list_parameters, *one) for one in prefixes]
    own = [one.topic_name for one in node.publishers]
    seen["publishers"] = own, ("/rosout", ["rcl_interfaces/msg/Log"]) in node.get_topic_names_and_types()


def endpoints(node: Node, executor: Any) -> None:
    """Facts about messages, event handlers, profiles as others see them, endpoints that are destroyed."""
    infos: list[dict[str, Any]] = []

    def note(_: String, info: dict[str, Any]) -> None:
        infos.append(info)

    class OwnPublisher(Publisher):
        """A publisher of the program."""

    quiet = PublisherEventCallbacks(use_default_callbacks=False, matched=ignore, deadline=ignore)
    publisher = node.create_publisher(String, "facts", 1, event_callbacks=quiet, publisher_class=OwnPublisher)
    subscription = node.create_subscription(String, "facts", note, 1)
    seen["callback types"] = subscription._callback_type.name
    three: Any = lambda _, _2, _3: None  # noqa: E731  # a callback as programs write it
    seen["three"] = attempt(node.create_subscription, String, "facts", three, 1)
    spin_until(executor, lambda: publisher.get_subscription_count() == 1)
    for _ in range(2):
        count = len(infos)
        publisher.publish(String())
        spin_until(executor, lambda count=count: len(infos) > count)
    seen["info"] = [sorted(infos[0]), [one["publication_sequence_number"] for one in infos]]
    seen["is stamped"] = all(one["source_timestamp"] > 0 for one in infos)
    plain = SubscriptionEventCallbacks()
    handled = node.create_subscription(String, "facts", ignore, 1, event_callbacks=plain)
    seen["handlers"] = [[int(one.event_type) for one in end.event_handlers] for end in (publisher, handled)]
    seen["own"] = isinstance(publisher, OwnPublisher)
    found = node.get_publishers_info_by_topic("facts")[0].qos_profile
    seen["discovered"] = found.liveliness.name, str(found.deadline), str(found.lifespan), found.reliability.name
    without = PublisherEventCallbacks(use_default_callbacks=False)
    second = node.create_publisher(String, "facts", 1, event_callbacks=without)
    spin_until(executor, lambda: subscription.get_publisher_count() == 2)
    second.destroy()
    spin_until(executor, lambda: subscription.get_publisher_count() == 1)
    seen["after destroy"] = node.count_publishers("facts"), attempt(lambda: second.topic_name)
    profile = QoSProfile(depth=3, durability=DurabilityPolicy.VOLATILE)
    options = QoSOverridingOptions((QoSPolicyKind.DEPTH, QoSPolicyKind.DURABILITY), entity_id="mine")
    node.create_publisher(String, "over", profile, qos_overriding_options=options)
    overrides = node.get_parameters_by_prefix("qos_overrides")
    seen["overrides"] = {name: one.value for name, one in sorted(overrides.items())}
    seen["numbers"] = repr(NumberOfEntities(1, 2) + NumberOfEntities(num_events=3))


def timers(node: Node) -> None:
    """Wrong periods, canceled timers, rates that are destroyed."""
    seen["negative"] = attempt(node.create_timer, -1.0, ignore)
    seen["rates"] = attempt(node.create_rate, 0.0), attempt(node.create_rate, -1.0)
    rate = node.create_rate(5.0)
    seen["destroyed rate"] = node.destroy_rate(rate), attempt(rate.sleep)
    timer = node.create_timer(10.0, ignore, autostart=False)
    seen["no autostart"] = timer.is_canceled(), timer.is_ready(), timer.time_until_next_call()
    timer.timer_period_ns = 5
    seen["period"] = timer.timer_period_ns
    seen["sources"] = attempt(TimeSource().attach_node, "node"), attempt(TimeSource().attach_clock, Clock())


def parameters_of_others(node: Node, executor: Any) -> None:
    """The client of parameters, callbacks for changes, and the services of logs."""
    other = rclpy.create_node("other", enable_logger_service=True, allow_undeclared_parameters=True)
    executor.add_node(other)
    other.declare_parameter("a.b", 1)
    other.declare_parameter("free", 1, ParameterDescriptor(dynamic_typing=True))
    client = AsyncParameterClient(node, "other")
    spin_until(executor, client.services_are_ready)
    changes: list[Any] = []
    handler = ParameterEventHandler(node)
    handle = handler.add_parameter_callback("a.b", "other", lambda one: changes.append(one.value.integer_value))
    handler.add_parameter_event_callback(lambda event: changes.append(event.node))
    spin_until(executor, lambda: handler.parameter_event_subscription.get_publisher_count() >= 2)

    def answer(future: Future) -> str:
        executor.spin_until_future_complete(future, 30.0)
        return repr(future.result())

    seen["client"] = [
        answer(client.get_parameters(["a.b"])),
        answer(client.list_parameters(["a"], 1)),
        answer(client.describe_parameters(["a.b"])),
        answer(client.get_parameter_types(["a.b", "free"])),
        answer(client.set_parameters([Parameter("a.b", value=2), Parameter("new", value="x").to_parameter_msg()])),
        answer(client.set_parameters_atomically([Parameter("a.b", value=3)])),
        answer(client.delete_parameters(["a.b", "free"])),
    ]
    spin_until(executor, lambda: changes.count("/other") == 4)
    handler.remove_parameter_callback(handle)
    seen["changes"] = changes, attempt(handler.remove_parameter_callback, handle)
    levels = [LoggerLevel(name="some.log", level=30), LoggerLevel(name="some.log", level=22)]
    services: Any = (
        (SetLoggerLevels, "other/set_logger_levels", SetLoggerLevels.Request(levels=levels)),
        (GetLoggerLevels, "other/get_logger_levels", GetLoggerLevels.Request(names=["some.log", "none"])),
    )
    replies = []
    for kind, name, request in services:
        asking = node.create_client(kind, name)
        spin_until(executor, asking.service_is_ready)
        replies.append(answer(asking.call_async(request)))
    seen["logger services"] = replies
    other.destroy_node()


def ends(node: Node) -> None:
    """Calls without an answer, executors and contexts that are shut down, wrong arguments of a node."""
    client = node.create_client(Trigger, "nowhere", callback_group=ReentrantCallbackGroup())
    seen["no answer"] = attempt(client.call, Trigger.Request(), 0.05)
    wrong = (["-r", "a"], ["-p", "a"], ["unknown"])
    seen["arguments of nodes"] = [
        attempt(rclpy.create_node, "wrong", cli_args=["--ros-args", *one]).partition(". Error")[0] for one in wrong
    ]
    seen["no text"] = attempt(rclpy.init, args=["\udcc3"], context=rclpy.Context())
    for kind in (SingleThreadedExecutor, MultiThreadedExecutor):
        ended = kind()
        ended.shutdown()
        seen[f"shutdown of {kind.__name__}"] = attempt(ended.spin_once), attempt(ended.wait_for_ready_callbacks)
    for kind in (SingleThreadedExecutor, MultiThreadedExecutor):
        ending = kind()
        ending.add_node(node)
        stop = node.create_guard_condition(lambda ending=ending: ending.shutdown())
        stop.trigger()
        ending.spin()
        node.destroy_guard_condition(stop)
    left = [kind() for kind in (SingleThreadedExecutor, MultiThreadedExecutor, EventsExecutor)]
    rclpy.shutdown()
    for one in left:
        seen[f"{type(one).__name__} after the shutdown"] = attempt(one.spin_once, 0.0)
    for one in left[:2]:  # rclpy's events executor waits forever at its second call
        seen[f"{type(one).__name__} in the end"] = [
            attempt(one.spin_once, 0.1),
            attempt(one.spin_once, -1.0),
            attempt(one.spin_once_until_future_complete, Future()),
            attempt(one.spin_until_future_complete, Future()),
            attempt(one.spin),
            attempt(one.wait_for_ready_callbacks),
            one.shutdown(),
            attempt(one.spin_once, 0.0),
            attempt(one.spin_once, 0.1),
        ]
    seen["after the shutdown"] = [
        attempt(node.create_publisher, String, "late", 1),
        attempt(node.create_subscription, String, "late", ignore, 1),
        attempt(client.service_is_ready),
        attempt(client.wait_for_service, 0.1),
    ]


def main() -> None:
    """Run all parts on an executor and print what was seen."""
    rclpy.init(args=[])
    logs()
    futures()
    records()
    node = rclpy.create_node("own")
    executor: Any = MultiThreadedExecutor(2) if "multi" in sys.argv else SingleThreadedExecutor()
    executor.add_node(node)
    if isinstance(executor, SingleThreadedExecutor):
        tasks(executor)
    names_of_node(node)
    endpoints(node, executor)
    timers(node)
    parameters_of_others(node, executor)
    executor.shutdown()
    ends(node)
    print(json.dumps(seen, indent=1))


if __name__ == "__main__":
    main()
