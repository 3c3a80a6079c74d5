"""Messages that a real client publishes to ROS, in CDR and JSON, and their rejection."""

from __future__ import annotations

import math

import pytest
from geometry_msgs.msg import Twist, Vector3
from rclpy.serialization import serialize_message
from std_msgs.msg import Bool, Int16MultiArray, String

from tests.bridge.studio import Studio
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol.constants import JSON, StatusLevel
from thymio_sim_ros.ros.foxglove.publishers import ClientPublishers


def test_a_clients_twist_reaches_a_subscriber(ros, studio):
    twists = []
    ros.node.create_subscription(Twist, "/cmd_vel", twists.append, 10)
    twist = Twist(linear=Vector3(x=0.1))
    studio.advertise(1, "/cmd_vel", "geometry_msgs/Twist")
    studio.send(ms.ClientMessageData(1, serialize_message(twist)))
    ros.until(lambda: twists)
    assert twists == [twist]


def test_a_client_may_publish_json(ros, studio):
    arrays = []
    ros.node.create_subscription(Int16MultiArray, "/_motor/target", arrays.append, 10)
    studio.advertise(1, "_motor/target", "std_msgs/msg/Int16MultiArray", JSON)
    studio.send(ms.ClientMessageData(1, b'{"data": [100, -100]}'))
    ros.until(lambda: arrays)
    assert list(arrays[0].data) == [100, -100]


def test_two_clients_with_equal_channel_ids_publish_each_to_its_own_topic(ros, bridge):
    received = []
    for topic in ("/a", "/b"):
        ros.node.create_subscription(String, topic, lambda m, topic=topic: received.append((topic, m.data)), 10)
    port = bridge().port
    with Studio(port, ros.until) as second:
        with Studio(port, ros.until) as first:
            first.advertise(1, "/a", "std_msgs/String", JSON)
            second.advertise(1, "/b", "std_msgs/String", JSON)
            first.send(ms.ClientMessageData(1, b'{"data": "first"}'))
            second.send(ms.ClientMessageData(1, b'{"data": "second"}'))
            ros.until(lambda: len(received) == 2)
        second.send(ms.ClientMessageData(1, b'{"data": "again"}'))
        ros.until(lambda: len(received) == 3)
    assert sorted(received) == [("/a", "first"), ("/b", "again"), ("/b", "second")]


def test_a_ros_publisher_lives_as_long_as_its_last_client_channel(ros, bridge):
    subscription = ros.node.create_subscription(String, "/a", lambda _: None, 10)
    port = bridge().port
    with Studio(port, ros.until) as first:
        with Studio(port, ros.until) as second:
            first.advertise(1, "/a", "std_msgs/String")
            second.advertise(9, "/a", "std_msgs/msg/String")
            ros.until(lambda: subscription.get_publisher_count() == 1)
        ros.until(lambda: ros.node.count_publishers("/a") == 1)
    ros.until(lambda: subscription.get_publisher_count() == 0)


@pytest.mark.parametrize(
    ("payload", "text"),
    [
        (b"\0\1\0\0\1", "/cmd_vel: expected a geometry_msgs/msg/Twist in cdr"),
        (b"", "/cmd_vel: expected a geometry_msgs/msg/Twist in cdr"),
        (serialize_message(Twist(linear=Vector3(x=math.nan))), "/cmd_vel: expected finite velocities, found NaN"),
        (serialize_message(Twist(angular=Vector3(z=math.inf))), "/cmd_vel: expected finite velocities, found NaN"),
    ],
    ids=["short", "empty", "nan", "inf"],  # the bytes differ from process to process: padding is not set
)
def test_a_bad_twist_is_rejected_and_the_next_good_one_is_published(ros, studio, payload, text):
    twists = []
    ros.node.create_subscription(Twist, "/cmd_vel", twists.append, 10)
    studio.advertise(1, "/cmd_vel", "geometry_msgs/Twist")
    studio.send(ms.ClientMessageData(1, payload))
    status = studio.next(ms.Status)
    assert status.level == StatusLevel.ERROR
    assert status.message.startswith(text)
    studio.send(ms.ClientMessageData(1, serialize_message(Twist())))
    ros.until(lambda: twists)
    assert twists == [Twist()]


@pytest.mark.parametrize(
    ("topic", "schema", "text"),
    [
        ("/a", "no_such_msgs/msg/Thing", "/a: type no_such_msgs/msg/Thing is not available"),
        ("/a", "nonsense", "/a: type nonsense is not available: expected package/msg/Type"),
        ("/a b", "std_msgs/msg/Bool", "/a b: not a valid topic name"),
        ("/a", "__main__/Foo", "/a: type __main__/msg/Foo is not available: there is no package __main__"),
        ("/a", "std_srvs/srv/SetBool", "'/a': cannot publish std_srvs/srv/SetBool"),
        ("/\ud800", "std_msgs/msg/Bool", "'/\\ud800': cannot publish std_msgs/msg/Bool"),
    ],
)
def test_a_channel_that_cannot_be_published_is_rejected(studio, topic, schema, text):
    studio.advertise(1, topic, schema)
    assert studio.next(ms.Status).message.startswith(text)


def test_a_second_type_on_a_topic_is_rejected(ros, studio):
    ros.node.create_subscription(Twist, "/cmd_vel", lambda _: None, 10)
    studio.advertise(1, "/cmd_vel", "std_msgs/msg/Bool")
    assert studio.next(ms.Status).message == "/cmd_vel: cannot publish std_msgs/msg/Bool, the topic has another type"


def test_clients_publish_only_on_allowed_topics(ros, bridge):
    with Studio(bridge(client_topic_whitelist=("/cmd_vel",)).port, ros.until) as studio:
        studio.advertise(1, "/other", "std_msgs/msg/Bool")
        assert "client_topic_whitelist" in studio.next(ms.Status).message


class Meeting:
    """A node with one subscriber on every topic, which its publisher matches after some time."""

    def __init__(self) -> None:
        self.now_s, self.has_met = 0.0, False
        self.received: list[tuple[float, bool]] = []
        self.created: list[str] = []

    def get_publishers_info_by_topic(self, _topic: str) -> list[object]:
        return []

    get_subscriptions_info_by_topic = get_publishers_info_by_topic

    def create_publisher(self, _type: type, topic: str, *_arguments: object, **_options: object) -> Meeting:
        self.created.append(topic)
        return self

    def count_subscribers(self, _topic: str) -> int:
        return 1

    def get_subscription_count(self) -> int:
        return int(self.has_met)

    def publish(self, message: Bool) -> None:
        self.received.append((round(self.now_s, 3), message.data))


def test_held_messages_are_published_at_the_intervals_of_their_arrival():
    node = Meeting()
    publishers = ClientPublishers(node, lambda _command: None, now_s=lambda: node.now_s)
    publishers.open(1, ms.ClientChannel(7, "/_press/forward", JSON, "std_msgs/Bool"))
    for ms_later in range(0, 700, 10):
        node.now_s, node.has_met = ms_later / 1000, ms_later >= 300
        if ms_later in (0, 120, 400):
            publishers.publish(1, 7, b'{"data": %s}' % (b"false" if ms_later == 120 else b"true"))
        publishers.poll()
    assert node.received == [(0.3, True), (0.42, False), (0.42, True)]
    publishers.publish(1, 7, b'{"data": false}')
    assert node.received[3:] == [(0.69, False)]


def test_a_channel_that_is_closed_immediately_creates_no_publisher() -> None:
    """Many channels that were opened and closed once kept the bridge busy for minutes."""
    node = Meeting()
    publishers = ClientPublishers(node, lambda _command: None)
    for number in range(100):
        publishers.open(1, ms.ClientChannel(number, f"/flood_{number}", JSON, "std_msgs/Bool"))
        publishers.close(1, number)
    assert not publishers.poll()
    assert node.created == []


def test_channels_of_all_clients_are_opened_in_turn() -> None:
    node = Meeting()
    publishers = ClientPublishers(node, lambda _command: None)
    for number in range(3):
        publishers.open(1, ms.ClientChannel(number, f"/flood_{number}", JSON, "std_msgs/Bool"))
    publishers.open(2, ms.ClientChannel(0, "/mine", JSON, "std_msgs/Bool"))
    while publishers.poll():
        pass
    assert node.created == ["/flood_0", "/mine", "/flood_1", "/flood_2"]
