"""One scenario for rclpy and for the embedded graph: runs in a process of its own and prints what happened as JSON.

Everything is compared that a program can see without the time of day: results, messages and their order on each topic,
reasons, exceptions and their texts.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from typing import Any

import rclpy
from geometry_msgs.msg import TransformStamped, Twist
from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    ParameterEvent,
    SetParametersResult,
)
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParameters
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.clock import ClockType
from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.expand_topic_name import expand_topic_name
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy, qos_check_compatible
from rclpy.serialization import deserialize_message, serialize_message
from rclpy.time import Time
from rclpy.validate_full_topic_name import validate_full_topic_name
from rclpy.validate_namespace import validate_namespace
from rclpy.validate_node_name import validate_node_name
from rclpy.validate_topic_name import validate_topic_name
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Int32, String
from std_srvs.srv import SetBool, Trigger

ARGUMENTS = """--ros-args -r __ns:=/space -r chat:=/talk -r own:other:=elsewhere -p whole:=3 -p real:=1e5
-p octal:=010 -p hex:=0x10 -p yes:=y -p text:='1' -p point:=.5 -p list:=[1,2] -p words:=[a,b] -p flags:=[true,off]
-p inf:=-.inf -p under:=1_000 -p plus:=+5 -p date:=2020-01-01 -p big:=99999999999999999999 -p deep.er:=1 -p empty:=''
-p own:mine:=7 -p absent:theirs:=8 --log-level own:=debug"""
PATIENCE_S = 30.0
seen: dict[str, Any] = {}


def attempt(action: Callable[..., Any], *args: Any, **kwargs: Any) -> str:
    """The result of a call as text, or the exception."""
    try:
        found = action(*args, **kwargs)
        return f"Parameter {found.name} = {found.value!r}" if isinstance(found, Parameter) else repr(found)
    except Exception as error:
        return f"{type(error).__name__}: {str(error).partition(', at ')[0]}"


def spin_until(executor: Any, condition: Callable[[], bool]) -> None:
    """Spin until a condition is true."""
    for _ in range(int(PATIENCE_S / 0.1) * 100):
        if condition():
            return
        executor.spin_once(timeout_sec=0.1)
    raise AssertionError("the condition did not become true")


def names() -> None:
    """Validation and expansion of names."""
    samples = ["", "/", "a/", "a b", "1a", "a/1b", "a~", "~a", "~/a", "a//b", "{x}", "a{", "a}b", "{a b}", "{1}", "/a_"]
    seen["topics"] = [attempt(validate_topic_name, one) for one in samples]
    seen["services"] = [attempt(validate_topic_name, one, is_service=True) for one in samples]
    full = ["", "a", "/", "/a/", "/a b", "/1a", "/a//b", "/a" * 150, "/a__b"]
    seen["full topics"] = [attempt(validate_full_topic_name, one) for one in full]
    seen["namespaces"] = [attempt(validate_namespace, one) for one in full]
    seen["node names"] = [attempt(validate_node_name, one) for one in ("", "a", "/a", "1a", "a b", "a" * 300)]
    expanded = ["a", "~/a", "~", "/a", "{node}", "{ns}/b", "{x}"]
    seen["expanded"] = [attempt(expand_topic_name, one, "node", "/space") for one in expanded]


def values() -> None:
    """Times, durations and profiles."""
    steady = Time(nanoseconds=5, clock_type=ClockType.STEADY_TIME)
    later = Time(seconds=2, nanoseconds=7)
    seen["times"] = [
        repr(later),
        repr(later - Time(seconds=1)),
        repr(later + Duration(seconds=0.5)),
        repr(later.to_msg()),
        attempt(lambda: later < steady),
        attempt(lambda: later - Duration(seconds=5)),
        attempt(Time, seconds=-1),
        attempt(Time, seconds=1e12),
        repr(Duration(nanoseconds=-1).to_msg()),
        str(Duration(seconds=1)),
        repr(Time.from_msg(later.to_msg())),
    ]
    plain = QoSProfile(depth=1)
    profiles = [
        plain,
        QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT),
        QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL),
        QoSProfile(depth=1, reliability=ReliabilityPolicy.SYSTEM_DEFAULT, durability=DurabilityPolicy.SYSTEM_DEFAULT),
        QoSProfile(depth=1, deadline=Duration(seconds=1), liveliness=LivelinessPolicy.AUTOMATIC),
        QoSProfile(depth=1, liveliness=LivelinessPolicy.MANUAL_BY_TOPIC),
        QoSProfile(depth=1, liveliness_lease_duration=Duration(seconds=1), liveliness=LivelinessPolicy.MANUAL_BY_TOPIC),
    ]
    seen["profiles"] = [str(one) for one in profiles] + [attempt(QoSProfile), attempt(QoSProfile, history=1)]
    pairs = [qos_check_compatible(one, other) for one in profiles for other in profiles]
    spelled = "durabil" + "ty"  # rmw's word
    seen["compatibility"] = [(found.name, reason.replace(spelled, "durability")) for found, reason in pairs]


def messages() -> None:
    """Serialized messages."""
    twist = Twist()
    twist.linear.x, twist.angular.z = 0.25, -1.0
    seen["bytes"] = serialize_message(twist).hex()
    seen["read"] = repr(deserialize_message(serialize_message(twist), Twist))
    seen["text"] = repr(TransformStamped(child_frame_id="b"))
    seen["broken"] = attempt(deserialize_message, b"\0\1\0\0ab", Twist).partition(":")[0]


def topics(node: Node, executor: Any) -> None:
    """Order, copies, history, late subscriptions, mismatches."""
    received: dict[str, list[Any]] = {"one": [], "two": [], "raw": [], "late": [], "last": []}
    publisher = node.create_publisher(String, "chat", 10)
    node.create_subscription(String, "chat", received["one"].append, 10)
    node.create_subscription(String, "/talk", received["two"].append, 10)
    node.create_subscription(String, "/talk", received["raw"].append, 10, raw=True)
    spin_until(executor, lambda: publisher.get_subscription_count() == 3)
    for number in range(5):
        publisher.publish(String(data=f"line {number}"))
    publisher.publish(serialize_message(String(data="bytes")))
    spin_until(executor, lambda: all(len(received[kind]) == 6 for kind in ("one", "two", "raw")))
    seen["lines"] = [one.data for one in received["one"]]
    seen["raw"] = [deserialize_message(one, String).data for one in received["raw"]]
    seen["copies"] = any(one is other for one, other in zip(received["one"], received["two"], strict=True))
    kept = QoSProfile(depth=2, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    retained = node.create_publisher(Int32, "retained", kept)
    for number in range(4):
        retained.publish(Int32(data=number))
    node.create_subscription(Int32, "retained", received["late"].append, kept)
    spin_until(executor, lambda: len(received["late"]) == 2)
    seen["late"] = [one.data for one in received["late"]]
    seen["refused"] = [
        attempt(node.create_publisher, String, "x", -1),
        attempt(node.create_publisher, String, "x", "a"),
        attempt(node.create_publisher, Trigger, "x", 1),
        attempt(node.create_publisher, str, "x", 1),
        attempt(node.create_publisher, Int32, "/talk", 1).partition(":")[0],
        attempt(node.create_publisher, String, "x y", 1),
        attempt(node.create_subscription, String, "1x", print, 1),
        attempt(node.create_service, Trigger, "a b", print),
        attempt(publisher.publish, "a").partition(",")[0],
    ]
    seen["resolved"] = [node.resolve_topic_name(one) for one in ("chat", "/chat", "other", "~/mine", "free")]


def events(node: Node, executor: Any) -> None:
    """Matches, mismatches, and errors of callbacks."""
    found: list[tuple[Any, ...]] = []
    publisher = node.create_publisher(
        String,
        "events",
        QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT),
        event_callbacks=PublisherEventCallbacks(
            incompatible_qos=lambda info: found.append(("misfit", info.total_count, int(info.last_policy_kind))),
            matched=lambda info: found.append(
                ("match", info.total_count, info.current_count, info.current_count_change)
            ),
        ),
    )
    quiet = SubscriptionEventCallbacks(use_default_callbacks=False)
    node.create_subscription(String, "events", print, 1, event_callbacks=quiet)
    spin_until(executor, lambda: len(found) == 1)
    fitting = node.create_subscription(String, "events", fail, publisher.qos_profile)
    spin_until(executor, lambda: len(found) == 2)
    errors: list[str] = []
    is_raised_at_once = isinstance(executor, SingleThreadedExecutor)
    if is_raised_at_once:
        publisher.publish(String(data="error"))
    while is_raised_at_once and not errors:
        try:
            executor.spin_once(timeout_sec=0.1)
        except ZeroDivisionError as error:
            errors.append(str(error))
    node.destroy_subscription(fitting)
    spin_until(executor, lambda: len(found) == 3)
    seen["endpoint events"] = found, errors


def fail(message: Any) -> None:
    """Raise an error."""
    raise ZeroDivisionError(message.data)


def services(node: Node, executor: Any) -> None:
    """Calls, coroutines, wrong requests."""

    def switch(request: Any, response: Any) -> Any:
        response.success, response.message = request.data, "switched"
        return response

    group = ReentrantCallbackGroup()
    node.create_service(SetBool, "switch", switch)
    client = node.create_client(SetBool, "switch", callback_group=group)
    spin_until(executor, client.service_is_ready)
    future = client.call_async(SetBool.Request(data=True))
    executor.spin_until_future_complete(future, PATIENCE_S)
    seen["response"] = repr(future.result())
    seen["wrong request"] = attempt(client.call_async, Trigger.Request()).partition(",")[0]

    async def ask() -> str:
        found = await client.call_async(SetBool.Request(data=False))
        return repr(found)

    task = executor.create_task(ask)
    executor.spin_until_future_complete(task, PATIENCE_S)
    seen["coroutine"] = task.result()


def parameters(node: Node, executor: Any) -> None:
    """Values of the start, declaration, ranges, callbacks, services, events."""
    changes: list[Any] = []
    node.create_subscription(ParameterEvent, "/parameter_events", changes.append, 100)
    spin_until(executor, lambda: node.count_publishers("/parameter_events") == 1)
    seen["start"] = {name: repr(one.value) for name, one in sorted(node._parameter_overrides.items())}
    whole = ParameterDescriptor(integer_range=[IntegerRange(from_value=0, to_value=10, step=2)])
    real = ParameterDescriptor(floating_point_range=[FloatingPointRange(from_value=0.0, to_value=1.0, step=0.25)])
    seen["declared"] = [
        attempt(node.declare_parameter, "speed", 4, whole),
        attempt(node.declare_parameter, "speed", 4),
        attempt(node.declare_parameter, "whole", 1.5),
        attempt(node.declare_parameter, "odd", 3, whole),
        attempt(node.declare_parameter, "none", None, ParameterDescriptor()),
        attempt(node.declare_parameter, "typed", Parameter.Type.STRING),
        attempt(node.declare_parameter, "part", 0.5, real),
        attempt(node.declare_parameter, "fixed", "a", ParameterDescriptor(read_only=True)),
        attempt(node.get_parameter, "typed"),
        attempt(node.get_parameter, "unknown"),
        attempt(node.undeclare_parameter, "fixed"),
    ]
    seen["set"] = [
        repr(node.set_parameters([Parameter(name, value=value)]))
        for name, value in (("speed", 6), ("speed", 5), ("speed", 12), ("speed", 1.0), ("part", 0.3), ("fixed", "b"))
    ]
    seen["set unknown"] = attempt(node.set_parameters, [Parameter("unknown", value=1)])

    def judge(changed: list[Parameter]) -> SetParametersResult:
        bad = any(one.name == "speed" and one.value == 8 for one in changed)
        return SetParametersResult(successful=not bad, reason="eight is too fast" if bad else "")

    node.add_on_set_parameters_callback(judge)
    seen["judged"] = repr(node.set_parameters([Parameter("speed", value=8), Parameter("speed", value=10)]))
    own = node.get_fully_qualified_name()
    requests = (
        (GetParameters, "get_parameters", GetParameters.Request(names=["speed", "part"])),
        (GetParameters, "get_parameters", GetParameters.Request(names=["speed", "unknown"])),
        (DescribeParameters, "describe_parameters", DescribeParameters.Request(names=["speed"])),
        (ListParameters, "list_parameters", ListParameters.Request(prefixes=["deep"], depth=0)),
        (
            SetParameters,
            "set_parameters",
            SetParameters.Request(
                parameters=[
                    Parameter("part", value=0.75).to_parameter_msg(),
                    Parameter("no", value=1).to_parameter_msg(),
                ]
            ),
        ),
    )
    replies = []
    for kind, name, request in requests:
        client = node.create_client(kind, f"{own}/{name}")
        spin_until(executor, client.service_is_ready)
        future = client.call_async(request)
        executor.spin_until_future_complete(future, PATIENCE_S)
        replies.append(repr(future.result()))
    seen["replies"] = replies
    spin_until(
        executor, lambda: any(one.changed_parameters and one.changed_parameters[0].name == "part" for one in changes)
    )
    seen["events"] = [
        (one.node, [p.name for p in one.new_parameters], [p.name for p in one.changed_parameters]) for one in changes
    ]


def clocks(node: Node, executor: Any) -> None:
    """Simulated time and timers."""
    publisher = node.create_publisher(Clock, "/clock", 1)
    node.set_parameters([Parameter("use_sim_time", value=True)])
    spin_until(executor, lambda: publisher.get_subscription_count() == 1)
    calls: list[int] = []
    timer = node.create_timer(1.0, lambda: calls.append(node.get_clock().now().nanoseconds))

    def advance(seconds: int) -> None:
        publisher.publish(Clock(clock=Time(seconds=seconds).to_msg()))
        spin_until(executor, lambda: node.get_clock().now().seconds_nanoseconds()[0] == seconds)

    for second in (1, 2, 4, 9):
        count = len(calls)
        advance(second)
        spin_until(executor, lambda count=count: len(calls) == count + 1)
    seen["calls"] = calls
    seen["until"] = timer.time_until_next_call()
    timer.cancel()
    seen["canceled"] = timer.is_canceled(), timer.time_until_next_call()
    node.set_parameters([Parameter("use_sim_time", value=False)])
    seen["wrong sim time"] = repr(node.set_parameters([Parameter("use_sim_time", value=1)]))


def graph(node: Node) -> None:
    """What a node can ask about the graph."""
    seen["topic names"] = [one for one in node.get_topic_names_and_types() if one[0] != "/rosout"]
    found = node.get_service_names_and_types()
    seen["service names"] = [one for one in found if "type_description" not in one[0]]
    seen["nodes"] = node.get_node_names_and_namespaces(), node.get_fully_qualified_name(), node.get_logger().name
    infos = node.get_publishers_info_by_topic("/talk")
    seen["infos"] = [
        (one.node_name, one.node_namespace, one.topic_type, str(one.topic_type_hash), one.endpoint_type.name)
        for one in infos
    ]
    seen["counts"] = node.count_publishers("/talk"), node.count_subscribers("/talk"), node.count_publishers("nothing")
    seen["no node"] = attempt(node.get_publisher_names_and_types_by_node, "no", "/").partition(":")[0]


def ending(node: Node) -> None:
    """Destroyed objects and contexts."""
    publisher = node.create_publisher(String, "ending", 1)
    seen["destroyed"] = [node.destroy_publisher(publisher), node.destroy_publisher(publisher)]
    seen["use after"] = attempt(publisher.publish, String())
    node.destroy_node()
    seen["use of node"] = attempt(node.create_publisher, String, "x", 1)
    rclpy.shutdown()
    seen["after shutdown"] = rclpy.ok(), attempt(rclpy.create_node, "late").partition(":")[0]
    context = rclpy.Context()
    wrong = (["--foo"], ["x", "y"], ["-r", "a"], ["-p", "a"], ["-p", "a:=[1,x]"], ["-r"], ["--log-level", "bad"])
    seen["arguments"] = [
        attempt(rclpy.init, args=["--ros-args", *one], context=context).partition(". Error")[0] for one in wrong
    ]


def main() -> None:
    """Run all parts on an executor and print what was seen."""
    rclpy.init(args=ARGUMENTS.split())
    node = rclpy.create_node("own")
    executor: Any = MultiThreadedExecutor(2) if "multi" in sys.argv else SingleThreadedExecutor()
    executor.add_node(node)
    names()
    values()
    messages()
    parameters(node, executor)
    topics(node, executor)
    events(node, executor)
    services(node, executor)
    clocks(node, executor)
    graph(node)
    executor.shutdown()
    ending(node)
    print(json.dumps(seen, indent=1))


if __name__ == "__main__":
    main()
