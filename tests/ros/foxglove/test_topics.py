"""ROS topics as channels for a real client: bytes, types, retained messages, publishers that start and end."""

from __future__ import annotations

import pytest
import rclpy
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import Log
from rclpy.context import Context
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message, serialize_message
from std_msgs.msg import Bool, String

from tests.bridge.studio import Studio
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.switchboard import events as ev
from thymio_sim_ros.ros.compat import tf2_messages
from thymio_sim_ros.ros.foxglove import topics as topics_module
from thymio_sim_ros.ros.foxglove.topics import Topics

TRANSIENT_LOCAL = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
BEST_EFFORT = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


def test_the_bytes_of_a_message_arrive_as_they_were_published(ros, studio):
    publisher = ros.node.create_publisher(String, "/chat", 10)
    studio.subscribe(7, "/chat")
    ros.until(publisher.get_subscription_count)
    message = String(data="hello")
    publisher.publish(message)
    data = studio.next(ms.MessageData)
    assert (data.subscription_id, data.payload) == (7, serialize_message(message))


def test_a_channel_carries_the_type_and_its_definition(ros, studio):
    ros.node.create_publisher(String, "/chat", 10)
    channel = studio.channel("/chat")
    assert (channel.encoding, channel.schema_name, channel.schema_encoding) == ("cdr", "std_msgs/msg/String", "ros2msg")
    assert "string data" in channel.schema


def test_a_topic_with_subscribers_only_is_a_channel_too(ros, studio):
    ros.node.create_subscription(Twist, "/cmd_vel", lambda _: None, 10)
    assert studio.channel("/cmd_vel").schema_name == "geometry_msgs/msg/Twist"


@pytest.fixture
def ending_at_once(monkeypatch):
    """Subscriptions end with their last client."""
    monkeypatch.setattr(topics_module, "KEEP_S", 0.0)


def test_ros_is_subscribed_only_while_a_client_subscribes(ros, studio, ending_at_once):
    publisher = ros.node.create_publisher(String, "/chat", 10)
    studio.subscribe(1, "/chat")
    ros.until(lambda: publisher.get_subscription_count() == 1)
    studio.send(ms.Unsubscribe((1,)))
    ros.until(lambda: publisher.get_subscription_count() == 0)


def test_a_client_that_leaves_ends_its_subscriptions(ros, bridge, ending_at_once):
    publisher = ros.node.create_publisher(String, "/chat", 10)
    with Studio(bridge().port, ros.until) as studio:
        studio.subscribe(1, "/chat")
        ros.until(lambda: publisher.get_subscription_count() == 1)
    ros.until(lambda: publisher.get_subscription_count() == 0)


def test_a_client_that_comes_back_gets_the_same_subscription_and_the_latest_message(ros, bridge, monkeypatch):
    """A new subscription leaves memory behind in the middleware."""
    publisher = ros.node.create_publisher(String, "/description", TRANSIENT_LOCAL)
    publisher.publish(String(data="old"))
    made = bridge()
    created = []
    create = made.node.create_subscription
    monkeypatch.setattr(made.node, "create_subscription", lambda *a, **kw: created.append(a) or create(*a, **kw))
    with Studio(made.port, ros.until) as studio:
        studio.subscribe(1, "/description")
        assert deserialize_message(studio.next(ms.MessageData).payload, String).data == "old"
    ros.until(lambda: made._server.client_count == 0)
    publisher.publish(String(data="new"))

    def found():
        with Studio(made.port, ros.until) as studio:
            studio.subscribe(1, "/description")
            return deserialize_message(studio.next(ms.MessageData).payload, String).data

    ros.until(lambda: found() == "new")
    assert len(created) == 1
    assert publisher.get_subscription_count() == 1


def test_the_subscription_of_the_bridge_keeps_no_topic_that_has_gone(ros, bridge):
    """Topics of a robot that was removed would stay on the page, and be reported as misspelled."""
    port = bridge().port
    with Studio(port, ros.until) as studio:
        for unsubscribes in (True, False):
            publisher = ros.node.create_publisher(String, "/chat", 10)
            studio.subscribe(1, "/chat")
            ros.until(lambda publisher=publisher: publisher.get_subscription_count() == 1)
            if unsubscribes:
                studio.send(ms.Unsubscribe((1,)))
            ros.node.destroy_publisher(publisher)
            ros.until(lambda: "/chat" not in studio.read().channels)


def test_messages_of_a_best_effort_publisher_are_received(ros, studio):
    publisher = ros.node.create_publisher(String, "/chat", BEST_EFFORT)
    studio.subscribe(1, "/chat")
    ros.until(publisher.get_subscription_count)
    publisher.publish(String(data="x"))
    assert studio.next(ms.MessageData).subscription_id == 1


def test_the_user_decides_what_is_received_without_guarantee(ros, bridge):
    for topic in ("/fast", "/sure"):
        ros.node.create_publisher(String, topic, 10)
    port = bridge(best_effort_qos_topic_whitelist=("/fast",)).port
    with Studio(port, ros.until) as studio:
        studio.subscribe(1, "/fast")
        studio.subscribe(2, "/sure")
        for topic, expected in (
            ("/fast", ReliabilityPolicy.BEST_EFFORT),
            ("/sure", ReliabilityPolicy.RELIABLE),
        ):
            ros.until(lambda topic=topic: ros.node.get_subscriptions_info_by_topic(topic))
            (info,) = ros.node.get_subscriptions_info_by_topic(topic)
            assert info.qos_profile.reliability == expected


def test_a_retained_message_is_sent_to_every_new_client_once(ros, bridge):
    publisher = ros.node.create_publisher(String, "/description", TRANSIENT_LOCAL)
    publisher.publish(String(data="old"))
    port = bridge().port
    with Studio(port, ros.until) as first, Studio(port, ros.until) as second:
        first.subscribe(1, "/description")
        payload = first.next(ms.MessageData).payload
        assert deserialize_message(payload, String).data == "old"
        second.subscribe(2, "/description")
        assert second.next(ms.MessageData).payload == payload
        publisher.publish(String(data="new"))
        for client in (first, second):
            assert deserialize_message(client.next(ms.MessageData).payload, String).data == "new"


def test_a_transient_local_publisher_that_starts_after_the_client_is_received(ros, studio):
    ros.node.create_subscription(String, "/description", lambda _: None, 1)
    studio.subscribe(1, "/description")
    publisher = ros.node.create_publisher(String, "/description", TRANSIENT_LOCAL)
    publisher.publish(String(data="late"))
    assert deserialize_message(studio.next(ms.MessageData).payload, String).data == "late"


def test_publishers_are_asked_for_their_qos_when_their_number_has_changed_and_else_now_and_then(ros, monkeypatch):
    names = ("/one", "/two")
    first = {name: ros.node.create_publisher(String, name, 10) for name in names}
    commands = []
    topics = Topics(ros.node, commands.append, lambda *_data: None, lambda: 0)
    topics.update({name: ["std_msgs/msg/String"] for name in names})
    for channel in commands[0].channels:
        topics.subscribe(channel.id)
    while topics.poll():  # unspun: an executor keeps a subscription that is destroyed outside of its callbacks
        pass
    asked = []
    ask = ros.node.get_publishers_info_by_topic
    monkeypatch.setattr(ros.node, "get_publishers_info_by_topic", lambda name: asked.append(name) or ask(name))

    def refresh_one_by_one(times):
        for _ in range(times):
            topics.refresh()
        found = sorted(asked)
        asked.clear()
        return found

    def reliability(name):
        (info,) = ros.node.get_subscriptions_info_by_topic(name)
        return info.qos_profile.reliability

    assert refresh_one_by_one(10) == ["/one", "/two"]
    ros.node.create_publisher(String, "/one", BEST_EFFORT)
    ros.until(lambda: ros.node.count_publishers("/one") == 2)
    assert "/one" in refresh_one_by_one(1)
    assert [reliability(name) for name in names] == [ReliabilityPolicy.BEST_EFFORT, ReliabilityPolicy.RELIABLE]
    ros.node.destroy_publisher(first["/two"])
    ros.node.create_publisher(String, "/two", BEST_EFFORT)
    ros.until(lambda: ros.node.count_publishers("/two") == 1)
    assert refresh_one_by_one(10) == ["/one", "/two"]
    assert reliability("/two") == ReliabilityPolicy.BEST_EFFORT
    topics.close()


def test_a_flood_of_changing_wishes_costs_a_share_of_time_and_the_last_wish_counts(ros, ending_at_once):
    for number in range(20):
        ros.node.create_publisher(Bool, f"/flood{number}", 1)
    commands, woken = [], []
    topics = Topics(ros.node, commands.append, lambda *_data: None, lambda: 0, wake=lambda: woken.append(True))
    topics.update({f"/flood{number}": ["std_msgs/msg/Bool"] for number in range(20)})
    ids = [channel.id for channel in commands[0].channels]
    for _ in range(200):
        for channel_id in ids:
            topics.subscribe(channel_id)
        for channel_id in ids:
            topics.unsubscribe(channel_id)
    topics.subscribe(ids[3])
    assert woken
    subscribed = [command for command in commands if isinstance(command, ev.RetainLast)]
    assert len(subscribed) < 200 * 20 / 4
    while topics.poll():
        pass
    assert topics.refresh()
    assert topics.subscribed == ("/flood3",)
    topics.close()


def test_a_refresh_of_many_topics_goes_on_where_it_stopped(ros, monkeypatch):
    names = [f"/many{number}" for number in range(10)]
    commands = []
    topics = Topics(ros.node, commands.append, lambda *_data: None, lambda: 0)
    topics.update({name: ["std_msgs/msg/Bool"] for name in names})
    for channel in commands[0].channels:
        topics.subscribe(channel.id)
    while topics.poll():
        pass
    counted = []
    monkeypatch.setattr(ros.node, "count_publishers", lambda name: counted.append(name) or 0)
    monkeypatch.setattr(ros.node, "get_publishers_info_by_topic", lambda name: counted.append(name) or [])
    slices = 1
    while not topics.refresh(slice_s=0.0):
        slices += 1
    assert slices > len(names) / 2
    assert sorted(counted) == names
    topics.close()


def test_a_topic_that_this_process_uses_with_another_type_is_named_with_both(ros, studio):
    logs = ros.collect(Log, "/rosout", where=lambda log: "not bridged" in log.msg)
    context = Context()
    rclpy.init(context=context, domain_id=ros.domain)
    try:
        other = Node("other", context=context, enable_rosout=False)
        other.create_publisher(Twist, "/chat", 10)
        assert studio.channel("/chat").schema_name == "geometry_msgs/msg/Twist"
        ros.node.create_subscription(String, "/chat", lambda _: None, 10)
        studio.subscribe(1, "/chat")
        ros.until(lambda: logs)
        other.destroy_node()
    finally:
        context.try_shutdown()
    found, expected = "geometry_msgs/msg/Twist", "std_msgs/msg/String"
    assert logs[0].msg == f"topic /chat is not bridged: found {found}, expected {expected} that this process uses there"


def test_a_vanished_topic_is_taken_away(ros, studio):
    publisher = ros.node.create_publisher(String, "/chat", 10)
    studio.channel("/chat")
    ros.node.destroy_publisher(publisher)
    ros.until(lambda: "/chat" not in studio.read().channels)


def test_unlisted_topics_and_those_of_actions_are_not_offered(ros, bridge):
    with Studio(bridge(topic_whitelist=("/list.*",)).port, ros.until) as studio:
        for topic in ("/other", "/_hidden/list", "/list/_action/status", "/list/_hidden", "/list/shown"):
            ros.node.create_publisher(Bool, topic, 1)
        studio.channel("/list/shown")
        studio.channel("/list/_hidden")
        assert set(studio.channels) == {"/list/shown", "/list/_hidden"}


def test_topics_of_actions_are_offered_on_demand(ros, bridge):
    ros.node.create_publisher(Bool, "/arm/_action/status", 1)
    with Studio(bridge(include_hidden=True).port, ros.until) as studio:
        assert studio.channel("/arm/_action/status").schema_name == "std_msgs/msg/Bool"


@pytest.mark.skipif(not tf2_messages.available(), reason="no transforms here")
def test_transforms_reach_the_client_without_tf2_msgs(ros, studio):
    publisher = ros.node.create_publisher(tf2_messages.TFMessage, "/tf", 10)
    studio.subscribe(1, "/tf")
    assert "MSG: geometry_msgs/TransformStamped" in studio.channel("/tf").schema
    ros.until(publisher.get_subscription_count)
    data = tf2_messages.encode([tf2_messages.Transform(5, "odom", "base_link", (1.0, 2.0, 0.0), (0.0, 0.0, 0.0, 1.0))])
    publisher.publish(data)
    assert studio.next(ms.MessageData).payload == data
