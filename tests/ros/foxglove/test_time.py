"""Simulated time for a real client."""

from __future__ import annotations

from rosgraph_msgs.msg import Clock
from std_msgs.msg import String

from tests.bridge.studio import Studio
from thymio_sim_ros.bridge.protocol import messages as ms


def test_simulated_time_is_sent_and_a_jump_back_starts_a_new_session(ros, bridge):
    publisher = ros.node.create_publisher(Clock, "/clock", 1)
    with Studio(bridge(use_sim_time=True).port, ros.until) as studio:
        first = studio.next(ms.ServerInfo)
        assert "time" in first.capabilities
        assert studio.next(ms.Time) == ms.Time(0)
        ros.until(publisher.get_subscription_count)
        publisher.publish(clock(5))
        assert studio.next(ms.Time) == ms.Time(5_000_000_000)
        publisher.publish(clock(1))
        assert studio.next(ms.ServerInfo).session_id != first.session_id
        assert studio.next(ms.Time) == ms.Time(1_000_000_000)


def test_messages_are_stamped_with_simulated_time(ros, bridge):
    clocks = ros.node.create_publisher(Clock, "/clock", 1)
    publisher = ros.node.create_publisher(String, "/chat", 10)
    with Studio(bridge(use_sim_time=True).port, ros.until) as studio:
        ros.until(clocks.get_subscription_count)
        clocks.publish(clock(5))
        studio.next(ms.Time, lambda time: time.time_ns > 0)
        studio.subscribe(1, "/chat")
        ros.until(publisher.get_subscription_count)
        publisher.publish(String())
        assert studio.next(ms.MessageData).time_ns == 5_000_000_000


def test_without_simulated_time_no_time_is_sent(studio):
    assert "time" not in studio.next(ms.ServerInfo).capabilities


def clock(seconds):
    message = Clock()
    message.clock.sec = seconds
    return message
