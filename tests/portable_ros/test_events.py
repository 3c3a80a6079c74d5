"""Events of endpoints that rclpy has between processes only."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tests.patience import Deadline
from thymio_sim_ros.portable_ros.messages.message_class import message_type
from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import RCLError
from thymio_sim_ros.portable_ros.rclpy.context import Context
from thymio_sim_ros.portable_ros.rclpy.duration import Duration, Infinite
from thymio_sim_ros.portable_ros.rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from thymio_sim_ros.portable_ros.rclpy.executors import SingleThreadedExecutor
from thymio_sim_ros.portable_ros.rclpy.node import Node
from thymio_sim_ros.portable_ros.rclpy.qos import DurabilityPolicy, LivelinessPolicy, QoSProfile

String, Int32 = message_type("std_msgs/msg/String"), message_type("std_msgs/msg/Int32")


def _spin_until(executor: SingleThreadedExecutor, condition: Callable[[], bool]) -> None:
    deadline = Deadline()
    while not condition() and not deadline.is_over:
        executor.spin_once(timeout_sec=0.1)
    assert condition()


def test_endpoints_of_another_type_are_reported_to_both_and_logged_by_default(
    capsys: pytest.CaptureFixture[str],
) -> None:
    context = Context()
    context.init([])
    node = Node("types", context=context, enable_rosout=False, start_parameter_services=False)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    found: list[tuple[str, int]] = []
    publisher = node.create_publisher(
        String,
        "topic",
        1,
        event_callbacks=PublisherEventCallbacks(
            incompatible_type=lambda info: found.append(("publisher", info.total_count))
        ),
    )
    noted = SubscriptionEventCallbacks(incompatible_type=lambda info: found.append(("subscription", info.total_count)))
    other_context = Context()  # a context uses a topic with one type
    other_context.init([])
    other = Node("other_types", context=other_context, enable_rosout=False, start_parameter_services=False)
    other_executor = SingleThreadedExecutor(context=other_context)
    other_executor.add_node(other)
    other.create_subscription(Int32, "topic", print, 1, event_callbacks=noted)
    other.create_subscription(Int32, "topic", print, 1)
    for _ in range(6):
        executor.spin_once(timeout_sec=0)
        other_executor.spin_once(timeout_sec=0)
    assert sorted(found) == [("publisher", 1), ("publisher", 2), ("subscription", 1)]
    assert publisher.get_subscription_count() == 0
    assert "Incompatible type on topic 'topic', no messages will be sent to it." in capsys.readouterr().err
    other.destroy_node()
    other_context.shutdown()
    node.destroy_node()
    context.shutdown()


def test_after_a_shutdown_the_number_of_matches_is_an_error() -> None:
    """Programs that wait for a subscription end by it: `ros2 topic pub --once` at Ctrl-C."""
    context = Context()
    context.init([])
    node = Node("counts", context=context, enable_rosout=False, start_parameter_services=False)
    publisher = node.create_publisher(String, "topic", 1)
    assert publisher.get_subscription_count() == 0
    context.shutdown()
    with pytest.raises(RCLError, match="failed to get subscription count: publisher's context is invalid"):
        publisher.get_subscription_count()
    node.destroy_node()


def test_a_publisher_that_asserts_its_liveliness_is_counted_and_told_that_it_has_lost_it(node: Node) -> None:
    """The events of Fast DDS in one process."""
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    inner: list[tuple[int, int, int, int]] = []
    lost: list[int] = []
    received: list[str] = []
    profile = QoSProfile(
        depth=1, liveliness=LivelinessPolicy.MANUAL_BY_TOPIC, liveliness_lease_duration=Duration(seconds=0.02)
    )
    subscription = node.create_subscription(
        String,
        "alive",
        lambda message: received.append(message.data),
        profile,
        event_callbacks=SubscriptionEventCallbacks(
            liveliness=lambda info: inner.append(
                (info.alive_count, info.not_alive_count, info.alive_count_change, info.not_alive_count_change)
            )
        ),
    )
    publisher = node.create_publisher(
        String,
        "alive",
        profile,
        event_callbacks=PublisherEventCallbacks(liveliness=lambda info: lost.append(info.total_count)),
    )
    executor.spin_once(timeout_sec=0.1)
    assert not inner, "a publisher is alive from its first assertion on"
    publisher.assert_liveliness()
    _spin_until(executor, lambda: lost == [1] and len(inner) == 2)
    assert inner == [(1, 0, 1, 0), (0, 1, -1, 1)]
    publisher.publish(String(data="one"))
    publisher.publish(String(data="two"))
    _spin_until(executor, lambda: lost == [1, 2] and len(inner) == 4)
    assert inner[2:] == [(1, 0, 1, -1), (0, 1, -1, 1)]
    assert not list(node.timers)
    node.destroy_publisher(publisher)
    _spin_until(executor, lambda: len(inner) == 5)
    assert inner[4] == (0, 0, 0, -1)
    assert not list(node.all_timers)
    assert received
    node.destroy_subscription(subscription)


def test_both_ends_of_a_topic_report_messages_that_miss_the_deadline(node: Node) -> None:
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    missed: list[tuple[str, int]] = []
    received: list[str] = []
    profile = QoSProfile(depth=1, deadline=Duration(seconds=0.02))
    publisher = node.create_publisher(
        String,
        "late",
        profile,
        event_callbacks=PublisherEventCallbacks(deadline=lambda info: missed.append(("out", info.total_count))),
    )
    subscription = node.create_subscription(
        String,
        "late",
        lambda message: received.append(message.data),
        profile,
        event_callbacks=SubscriptionEventCallbacks(deadline=lambda info: missed.append(("in", info.total_count))),
    )
    executor.spin_once(timeout_sec=0.1)
    assert not missed, "the deadline begins with the first message"
    publisher.publish(String(data="only"))
    wait = Deadline()
    while not {("out", 2), ("in", 2)} <= set(missed):
        assert not wait.is_over, missed
        executor.spin_once(timeout_sec=0.1)
    assert received == ["only"]
    assert not list(node.timers)
    node.destroy_publisher(publisher)
    node.destroy_subscription(subscription)
    assert not list(node.all_timers)


@pytest.mark.parametrize(("lifespan", "expected"), [(Duration(), 1), (Duration(nanoseconds=1), 0), (Infinite, 1)])
def test_a_late_subscription_gets_no_messages_that_are_older_than_their_lifespan(
    node: Node, lifespan: Duration, expected: int
) -> None:
    profile = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL, lifespan=lifespan)
    node.create_publisher(String, "kept", profile).publish(String())
    late = node.create_subscription(
        String, "kept", lambda _: None, QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    )
    assert late.pending() == expected
