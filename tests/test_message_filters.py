"""`message_filters`, as course files import it where it is not installed."""

from __future__ import annotations

import importlib.util
from typing import Any

import pytest

if importlib.util.find_spec("rclpy") is None:
    pytest.skip("needs rclpy", allow_module_level=True)

from builtin_interfaces.msg import Time as Stamp
from rclpy.time import Time
from sensor_msgs.msg import Range
from std_msgs.msg import Header, Int32

from thymio_sim_ros.course_packages.packages.message_filters import (
    ApproximateTimeSynchronizer,
    Cache,
    SimpleFilter,
    Subscriber,
    TimeSynchronizer,
)


def at(nanoseconds: int) -> Range:
    return Range(header=Header(stamp=Stamp(nanosec=nanoseconds)))


def time_of(message: Range) -> int:
    return int(message.header.stamp.nanosec)


def synchronized(kind: type[TimeSynchronizer], inputs: int, *options: Any) -> tuple[list[SimpleFilter], list[Any]]:
    """Filters, and the times of the messages that were put together."""
    filters = [SimpleFilter() for _ in range(inputs)]
    found: list[Any] = []
    kind(filters, *options).registerCallback(lambda *messages: found.append(tuple(map(time_of, messages))))
    return filters, found


def test_messages_of_the_same_time_are_put_together() -> None:
    (left, right), found = synchronized(TimeSynchronizer, 2, 10)
    for nanoseconds in (1, 2, 3):
        left.signalMessage(at(nanoseconds))
    for nanoseconds in (4, 3, 1):
        right.signalMessage(at(nanoseconds))
    assert found == [(3, 3), (1, 1)]
    right.signalMessage(at(1))  # each message is used once
    assert len(found) == 2


def test_the_oldest_messages_do_not_wait_for_ever() -> None:
    (left, right), found = synchronized(TimeSynchronizer, 2, 2)
    for nanoseconds in (1, 2, 3):
        left.signalMessage(at(nanoseconds))
    for nanoseconds in (1, 2, 3):
        right.signalMessage(at(nanoseconds))
    assert found == [(2, 2), (3, 3)]


def test_messages_of_about_the_same_time_are_put_together_with_the_nearest() -> None:
    (left, right), found = synchronized(ApproximateTimeSynchronizer, 2, 10, 10e-9)
    for nanoseconds in (100, 106, 130):
        left.signalMessage(at(nanoseconds))
    right.signalMessage(at(105))
    assert found == [(106, 105)]
    right.signalMessage(at(119))
    assert len(found) == 1
    right.signalMessage(at(140))  # the greatest difference is allowed
    assert found[1:] == [(130, 140)]


def test_all_of_them_are_within_the_slop() -> None:
    (one, two, three), found = synchronized(ApproximateTimeSynchronizer, 3, 10, 10e-9)
    for nanoseconds in (92, 109):
        one.signalMessage(at(nanoseconds))
    two.signalMessage(at(108))
    three.signalMessage(at(100))  # 92 is nearer, and too far from 108
    assert found == [(109, 108, 100)]


def test_messages_without_a_time_are_dropped_or_have_that_of_their_arrival() -> None:
    (left, right), found = synchronized(ApproximateTimeSynchronizer, 2, 10, 1e9)
    left.signalMessage(Int32(data=1))
    right.signalMessage(at(1))
    assert found == []
    filters = SimpleFilter(), SimpleFilter()
    together: list[Any] = []
    both = ApproximateTimeSynchronizer(filters, 10, 60.0, allow_headerless=True)
    both.registerCallback(lambda *messages: together.append(messages))
    filters[0].signalMessage(Int32(data=1))
    filters[1].signalMessage(Int32(data=2))
    assert together == [(Int32(data=1), Int32(data=2))]


def test_a_callback_gets_its_arguments() -> None:
    source, found = SimpleFilter(), []
    source.registerCallback(lambda *values: found.append(values), "a", 2)
    source.signalMessage(1)
    assert found == [(1, "a", 2)]


def test_a_cache_knows_the_last_messages_by_their_times() -> None:
    source, passed = SimpleFilter(), []
    cache = Cache(source, 3)
    cache.registerCallback(passed.append)
    assert (cache.getLast(), cache.getLastestTime(), cache.getOldestTime()) == (None, None, None)
    for nanoseconds in (10, 40, 20, 30):
        source.signalMessage(at(nanoseconds))
    assert list(map(time_of, passed)) == [10, 40, 20, 30]
    assert list(map(time_of, cache.getInterval(Time(nanoseconds=15), Time(nanoseconds=30)))) == [20, 30]
    assert time_of(cache.getElemAfterTime(Time(nanoseconds=30))) == 30
    assert time_of(cache.getElemBeforeTime(Time(nanoseconds=39))) == 30
    assert cache.getElemBeforeTime(Time(nanoseconds=19)) is None
    assert cache.getElemAfterTime(Time(nanoseconds=41)) is None
    assert time_of(cache.getLast()) == 40
    latest, oldest = cache.getLastestTime(), cache.getOldestTime()
    assert latest is not None
    assert oldest is not None
    assert (oldest.nanoseconds, latest.nanoseconds) == (20, 40)


NODE = """\
import rclpy
from message_filters import ApproximateTimeSynchronizer, Subscriber
from nav_msgs.msg import Odometry
from rclpy.node import Node
from sensor_msgs.msg import Range
from std_msgs.msg import Float64


class Fuser(Node):
    def __init__(self):
        super().__init__("fuser")
        self.out = self.create_publisher(Float64, "fused", 10)
        self.inputs = [Subscriber(self, Range, "proximity/center"), Subscriber(self, Odometry, "odom", qos_profile=10)]
        self.both = ApproximateTimeSynchronizer(self.inputs, 10, 0.1)
        self.both.registerCallback(self.fuse)

    def fuse(self, range, odometry):
        self.out.publish(Float64(data=odometry.pose.pose.position.x))


rclpy.init()
rclpy.spin(Fuser())
"""


@pytest.mark.process
def test_a_node_fuses_topics_of_the_robot(ros, simulation, tmp_path) -> None:
    from std_msgs.msg import Float64

    sim = simulation()
    (tmp_path / "fuser.py").write_text(NODE)
    ros.start(tmp_path / "fuser.py")
    fused = ros.collect(Float64, "fused")
    sim.until(lambda: len(fused) >= 3, 5.0)


def test_a_subscriber_passes_messages_on(ros) -> None:
    node = ros.node
    subscriber = Subscriber(node, Int32, "numbers")
    found: list[int] = []
    subscriber.registerCallback(lambda message: found.append(message.data))
    assert (subscriber.getTopic(), subscriber.topic_name) == ("numbers", "/numbers")
    publisher = node.create_publisher(Int32, "numbers", 10)
    ros.until(lambda: publisher.get_subscription_count() == 1)
    publisher.publish(Int32(data=5))
    ros.until(lambda: found == [5])
