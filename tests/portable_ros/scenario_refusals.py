"""What rclpy and the embedded graph refuse alike (see scenario.py): wrong arguments, and use after a shutdown."""

from __future__ import annotations

import json
from typing import Any

import rclpy
from rcl_interfaces.msg import Log
from rclpy.clock import ClockChange, JumpThreshold, ROSClock, TimeJump
from rclpy.clock_type import ClockType
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import qos_profile_system_default
from rclpy.service_introspection import ServiceIntrospectionState
from rclpy.signals import SignalHandlerOptions, get_current_signal_handlers_options, install_signal_handlers
from rclpy.time import Time
from scenario import attempt, seen
from std_msgs.msg import String
from std_srvs.srv import Trigger


def kind_of_error(action: Any, *args: Any, **kwargs: Any) -> str:
    """The result of a call as text, or the class of its exception with the beginning of its text."""
    return ":".join(attempt(action, *args, **kwargs).split(":")[:2])


def constants() -> None:
    """Constants of messages, which cannot be changed."""
    seen["constants"] = [
        attempt(setattr, Log, "INFO", 1),
        attempt(delattr, Log, "INFO"),
        attempt(setattr, Log(), "INFO", 1),
        Log.INFO,
    ]


def queries(node: Node) -> None:
    """Names of nodes that do not exist or are not valid."""
    ask = (
        node.get_publisher_names_and_types_by_node,
        node.get_subscriber_names_and_types_by_node,
        node.get_service_names_and_types_by_node,
        node.get_client_names_and_types_by_node,
    )
    names = (("own", ""), ("own", "x"), ("other", "/"), ("own", "/t"), ("", "/"), ("o n", "/"), ("own", "/s/"))
    for query in ask:
        results = [attempt(query, *name) for name in names]
        # rcl adds the number of its result, and says nothing about the node that there is not.
        seen[query.__name__] = [one.partition(", result")[0].partition(" node: ")[0] for one in results]
    seen["nodes"] = [node.wait_for_node(name, 0.2) for name in ("own", "/own", "//own", "other", "")]


def foreign_objects(node: Node) -> None:
    """What is destroyed as something else, or is nothing of the node."""
    publisher, timer = node.create_publisher(String, "a", 1), node.create_timer(9.0, print)
    guard = node.create_guard_condition(print)
    destroy: Any = (
        node.destroy_publisher,
        node.destroy_subscription,
        node.destroy_client,
        node.destroy_service,
        node.destroy_timer,
        node.destroy_guard_condition,
    )
    for action in destroy:
        wrong = [one for one in (publisher, timer, guard) if type(one).__name__.lower()[:5] not in action.__name__]
        seen[action.__name__] = [attempt(action, one) for one in (None, 5, *wrong)]
    seen["still there"] = publisher.topic_name, timer.is_ready(), attempt(guard.trigger)
    wrong_name: Any = 5
    seen["no name"] = attempt(node.create_publisher, String, wrong_name, 1).partition(":")[0]
    node.destroy_timer(timer)
    seen["period of a destroyed timer"] = attempt(lambda: timer.timer_period_ns)


def introspection(node: Node) -> None:
    """States that are none."""
    client, service = node.create_client(Trigger, "s"), node.create_service(Trigger, "s", lambda _, reply: reply)
    states: Any = (1, "METADATA", None, ServiceIntrospectionState.METADATA, ServiceIntrospectionState.OFF)
    for end in (client, service):
        configure = end.configure_introspection
        seen[f"introspection of {type(end).__name__}"] = [
            kind_of_error(configure, node.get_clock(), qos_profile_system_default, state) for state in states
        ]


def signals() -> None:
    """Options that are none."""
    options: Any = (1, "ALL", None)
    seen["signals"] = [kind_of_error(install_signal_handlers, one) for one in options]
    context = rclpy.Context()
    wrong: Any = 5
    seen["options"] = kind_of_error(rclpy.init, args=[], context=context, signal_handler_options=wrong), context.ok()
    seen["handled"] = get_current_signal_handlers_options() == SignalHandlerOptions.ALL


def jumps() -> None:
    """Which jumps of a clock are reported, and what callbacks that fail do."""
    clock, calls = ROSClock(), []
    second = Duration(seconds=1)
    threshold = JumpThreshold(min_forward=second, min_backward=Duration(seconds=-1))

    def after(jump: TimeJump) -> None:
        is_plain = jump.clock_change == ClockChange.ROS_TIME_NO_CHANGE
        calls.append((jump.clock_change.name, jump.delta.nanoseconds if is_plain else None))

    def set_to(seconds: float) -> None:
        clock.set_ros_time_override(Time(seconds=seconds, clock_type=ClockType.ROS_TIME))
        calls.append(seconds)

    handle = clock.create_jump_callback(threshold, pre_callback=lambda: calls.append("before"), post_callback=after)
    threshold.min_forward = None
    clock._set_ros_time_is_active(True)
    for at in (10, 10.5, 11.5, 10.6, 10.5, 9, 9, 100, 101, 100):
        set_to(at)
    for is_active in (True, False, False):
        clock._set_ros_time_is_active(is_active)
    set_to(500)
    clock._set_ros_time_is_active(True)
    handle.unregister()
    handle.unregister()
    set_to(1000)
    seen["jumps"] = calls
    wrong: Any = 5
    seen["wrong time"] = attempt(clock.set_ros_time_override, wrong)
    seen["no threshold"] = attempt(clock.create_jump_callback, wrong, post_callback=print).partition(":")[0]
    failing = clock.create_jump_callback(JumpThreshold(min_forward=second, min_backward=None), post_callback=fail)
    seen["failing"] = attempt(set_to, 2000), clock.now().nanoseconds
    failing.unregister()


def fail(_: TimeJump) -> None:
    """A callback with an error."""
    raise ValueError("no")


def after_shutdown(node: Node) -> None:
    """A node whose context is shut down."""
    publisher = node.create_publisher(String, "x", 1)
    node.declare_parameter("a", 1)
    rclpy.shutdown()
    uses: Any = (
        node.get_topic_names_and_types,
        node.get_service_names_and_types,
        node.get_node_names,
        node.get_node_names_and_namespaces,
        node.get_fully_qualified_node_names,
        lambda: node.get_client_names_and_types_by_node("o n", "/"),
        lambda: node.count_publishers("x"),
        lambda: node.count_subscribers("x"),
        lambda: node.count_services("x"),
        lambda: node.count_clients("x"),
        lambda: node.get_publishers_info_by_topic("x"),
        lambda: node.get_subscriptions_info_by_topic("x"),
        publisher.wait_for_all_acked,
        lambda: node.create_timer(1.0, print),
        lambda: node.create_rate(1.0),
        lambda: node.create_guard_condition(print),
        lambda: node.create_client(Trigger, "q"),
        lambda: node.create_service(Trigger, "q", print),
    )
    seen["after the shutdown"] = [attempt(one) for one in uses]
    seen["parameter"] = node.get_parameter("a").value


def main() -> None:
    """Run all parts and print what was seen."""
    rclpy.init(args=[])
    node = rclpy.create_node("own")
    constants()
    queries(node)
    foreign_objects(node)
    introspection(node)
    signals()
    jumps()
    after_shutdown(node)
    print(json.dumps(seen, indent=1))


if __name__ == "__main__":
    main()
