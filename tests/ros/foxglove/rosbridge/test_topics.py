"""Clients of rosbridge that publish and subscribe, on the ROS graph."""

from __future__ import annotations

import base64
import json
import math

import pytest
from geometry_msgs.msg import Twist, TwistStamped
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import CompressedImage, LaserScan
from std_msgs.msg import Float64, Int64, String, UInt8MultiArray

from tests.bridge.ros_client import RosClient
from tests.ros_graph import IS_EMBEDDED
from thymio_sim_ros.ros.interface.qos import TRANSIENT_LOCAL


@pytest.fixture
def texts(ros):
    """A publisher of texts."""
    return ros.node.create_publisher(String, "/texts", 10)


def _subscribed(ros, publisher):
    ros.until(lambda: publisher.get_subscription_count() == 1)


def test_a_client_gets_the_messages_of_a_topic(ros, roslib, texts):
    roslib.send("subscribe", topic="/texts", type="std_msgs/String", id="s1")
    _subscribed(ros, texts)
    texts.publish(String(data="é"))
    assert roslib.next("publish") == {"op": "publish", "topic": "/texts", "msg": {"data": "é"}}


def test_the_type_of_a_topic_that_exists_may_be_missing(ros, roslib, texts):
    roslib.send("subscribe", topic="texts")
    _subscribed(ros, texts)
    texts.publish(String(data="a"))
    assert roslib.next("publish")["topic"] == "texts"


def test_requests_for_one_topic_get_each_message_once_until_the_last_ends(ros, roslib, texts):
    for name in ("one", "two"):
        roslib.send("subscribe", topic="/texts", id=name)
    _subscribed(ros, texts)
    roslib.send("unsubscribe", topic="/texts", id="one")
    roslib.send("unsubscribe", topic="/texts", id="none")
    texts.publish(String(data="a"))
    texts.publish(String(data="b"))
    assert [roslib.next("publish")["msg"]["data"] for _ in range(2)] == ["a", "b"]
    roslib.send("unsubscribe", topic="/texts", id="two")
    ros.until(lambda: texts.get_subscription_count() == 0)


def test_a_client_gets_retained_messages_also_if_it_subscribed_before_their_publisher(ros, roslib):
    roslib.send("subscribe", topic="/map_name", type="std_msgs/String")
    ros.until(lambda: ros.node.count_subscribers("/map_name") == 1)
    publisher = ros.node.create_publisher(String, "/map_name", TRANSIENT_LOCAL)
    publisher.publish(String(data="retained"))
    assert roslib.next("publish")["msg"] == {"data": "retained"}


def test_a_client_publishes_and_the_missing_fields_have_defaults(ros, roslib):
    twists = []
    ros.node.create_subscription(Twist, "/cmd_vel", twists.append, 10)
    roslib.send("advertise", topic="/cmd_vel", type="geometry_msgs/Twist", id="a", latch=False, queue_size=100)
    roslib.send("publish", topic="/cmd_vel", msg={"linear": {"x": 1}}, id="p")
    ros.until(lambda: twists)
    assert (twists[0].linear.x, twists[0].angular.z) == (1.0, 0.0)


def test_a_topic_that_is_not_advertised_is_advertised_by_its_first_message(ros, roslib):
    twists = []
    ros.node.create_subscription(Twist, "/cmd_vel", twists.append, 10)
    roslib.send("publish", topic="/cmd_vel", msg={})
    ros.until(lambda: twists)


def test_a_publisher_lives_until_its_last_user_unadvertises(ros, roslib):
    subscription = ros.node.create_subscription(String, "/a", lambda _: None, 10)
    for name in ("one", "two"):
        roslib.send("advertise", topic="/a", type="std_msgs/String", id=name)
    ros.until(lambda: subscription.get_publisher_count() == 1)
    roslib.send("unadvertise", topic="/a", id="one")
    roslib.call("/rosapi/nodes")
    assert subscription.get_publisher_count() == 1
    roslib.send("unadvertise", topic="/a", id="two")
    ros.until(lambda: subscription.get_publisher_count() == 0)


def test_a_latched_message_reaches_a_late_subscriber(ros, roslib):
    found = []
    roslib.send("advertise", topic="/a", type="std_msgs/String", latch=True)
    roslib.send("publish", topic="/a", msg={"data": "kept"})
    ros.until(lambda: ros.node.count_publishers("/a") == 1)
    roslib.call("/rosapi/nodes")
    ros.node.create_subscription(String, "/a", found.append, TRANSIENT_LOCAL)
    ros.until(lambda: found)


def test_what_a_client_leaves_is_gone(ros, bridge, texts):
    with RosClient(bridge().port, ros.until) as client:
        client.send("node", id="n", name="my_node")
        client.send("advertise", topic="/a", type="std_msgs/String", node="n")
        client.send("subscribe", topic="/texts")
        client.send("advertise_service", service="/s", type="std_srvs/Trigger", node="n")
        _subscribed(ros, texts)
        ros.until(lambda: ros.node.count_services("/s"))
    ros.until(lambda: texts.get_subscription_count() == 0)
    ros.until(lambda: not ros.node.count_publishers("/a") and not ros.node.count_services("/s"))
    assert "my_node" not in ros.node.get_node_names()


@pytest.mark.parametrize(
    ("kind", "message", "text"),
    [
        ("geometry_msgs/Twist", {"linear": {"q": 1}}, "publish.msg.linear: no field q; fields are x, y, z"),
        ("geometry_msgs/Twist", {"linear": {"x": "1"}}, "publish.msg.linear.x: expected double, found '1'"),
        ("geometry_msgs/Twist", {"linear": {"x": None}}, "expected finite velocities, found NaN or infinity"),
        ("geometry_msgs/Twist", {"linear": {"x": math.inf}}, "expected finite velocities, found NaN or infinity"),
        ("geometry_msgs/Twist", [1], "publish.msg: expected an object, found [1]"),
        ("std_msgs/Int8", {"data": 128}, "publish.msg.data: expected int8, found 128"),
        ("std_msgs/UInt8MultiArray", {"data": "?"}, "publish.msg.data: expected a list or base64, found '?'"),
        ("std_msgs/Nothing", {}, "advertise.type: type std_msgs/msg/Nothing is not available"),
        ("nothing", {}, "advertise.type: type nothing is not available: expected package/msg/Type"),
        ("std_srvs/srv/Trigger", {}, "advertise.type: expected the type of a message, found std_srvs/srv/Trigger"),
    ],
)
def test_a_wrong_message_is_answered_with_the_place_of_the_fault(roslib, kind, message, text):
    roslib.send("advertise", topic="/a", type=kind, id="first")
    roslib.send("publish", topic="/a", msg=message, id="second")
    status = roslib.next("status")
    assert text in status["msg"]
    assert (status["level"], status["id"]) == ("error", "first" if text.startswith("advertise") else "second")


@pytest.mark.parametrize(
    ("op", "fields", "text"),
    [
        (
            "subscribe",
            {"topic": "/nothing"},
            "subscribe.type: expected a name in the ROS graph, or a type, found /nothing",
        ),
        (
            "subscribe",
            {"topic": "a b", "type": "std_msgs/Bool"},
            "subscribe.topic: expected a name of ROS, found 'a b'",
        ),
        ("subscribe", {"topic": "/a", "type": "std_srvs/srv/Trigger"}, "subscribe.type: "),
        (
            "subscribe",
            {"topic": "/a", "type": "std_msgs/Bool", "qos": {"depth": -1}},
            "subscribe.qos.depth: expected an",
        ),
        (
            "subscribe",
            {"topic": "/a", "type": "std_msgs/Bool", "node": "x"},
            "subscribe.node: expected the id of a node",
        ),
        ("publish", {"topic": "/nothing", "msg": {}}, "publish.type: expected a name in the ROS graph, or a type"),
        ("unadvertise", {"topic": "/a"}, "unadvertise.topic: expected an advertised one, found /a"),
        ("unsubscribe", {"topic": "/a"}, "unsubscribe.topic: expected a subscribed one, found /a"),
        (
            "advertise",
            {"topic": "/a", "type": "std_msgs/Bool", "qos": {"durability": "x"}},
            "advertise.qos.durability: ",
        ),
        ("node", {"id": "n", "name": "a b"}, "node.name: "),
        ("remove_node", {"id": "n"}, "remove_node.id: expected the id of a node, found 'n'"),
        ("fly", {}, "op: expected one of "),
    ],
)
def test_a_wrong_operation_is_answered_with_the_field(roslib, op, fields, text):
    roslib.send(op, **{"id": 7, **fields})
    status = roslib.next("status")
    assert text in status["msg"]
    assert (status["level"], status["id"]) == ("error", fields.get("id", 7))


def test_values_of_messages_are_those_of_rosbridge(ros, roslib):
    floats = ros.node.create_publisher(Float64, "/float", 10)
    large = ros.node.create_publisher(Int64, "/int", 10)
    scans = ros.node.create_publisher(LaserScan, "/scan", 10)
    images = ros.node.create_publisher(CompressedImage, "/image", 10)
    for publisher in (floats, large, scans, images):
        roslib.send("subscribe", topic=publisher.topic_name)
        _subscribed(ros, publisher)
    floats.publish(Float64(data=math.nan))
    large.publish(Int64(data=(1 << 62) + 1))
    scans.publish(LaserScan(ranges=[1.0, math.inf]))
    images.publish(CompressedImage(data=b"\1\xff"))
    found = {each["topic"]: each["msg"] for each in (roslib.next("publish") for _ in range(4))}
    assert found["/float"] == {"data": None}
    assert found["/int"] == {"data": (1 << 62) + 1}
    assert found["/scan"]["ranges"] == [1.0, None]
    assert found["/scan"]["header"] == {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""}
    assert found["/image"]["data"] == base64.b64encode(b"\1\xff").decode()


@pytest.mark.parametrize("data", [[1, 255], base64.b64encode(b"\1\xff").decode()])
def test_bytes_are_base64_or_a_list(ros, roslib, data):
    found = []
    ros.node.create_subscription(UInt8MultiArray, "/bytes", found.append, 10)
    roslib.send("publish", topic="/bytes", msg={"data": data})
    ros.until(lambda: found)
    assert list(found[0].data) == [1, 255]


def test_a_message_without_a_stamp_gets_the_time(ros, roslib):
    found = []
    ros.node.create_subscription(TwistStamped, "/stamped", found.append, 10)
    roslib.send("publish", topic="/stamped", msg={"header": {"frame_id": "a"}})
    roslib.send("publish", topic="/stamped", msg={"header": {"stamp": {"secs": 5, "nsecs": 6}}})
    ros.until(lambda: len(found) == 2)
    assert found[0].header.stamp.sec > 5
    assert found[0].header.frame_id == "a"
    assert (found[1].header.stamp.sec, found[1].header.stamp.nanosec) == (5, 6)


@pytest.mark.parametrize("compression", ["cbor", "cbor-raw", "png"])
def test_a_client_may_want_messages_compressed(ros, roslib, compression):
    scans = ros.node.create_publisher(LaserScan, "/scan", 10)
    roslib.send("subscribe", topic="/scan", compression=compression, type="sensor_msgs/LaserScan")
    _subscribed(ros, scans)
    message = LaserScan(range_max=2.5, ranges=[1.0, math.inf])
    scans.publish(message)
    if compression == "png":
        assert base64.b64decode(roslib.next("png")["data"]).startswith(b"\x89PNG")
        return
    found = roslib.next("publish")["msg"]
    if compression == "cbor":
        assert (found["range_max"], found["ranges"].tag, len(found["ranges"].value)) == (2.5, 85, 8)
    else:
        assert found["secs"] > 0
        assert deserialize_message(found["bytes"], LaserScan) == message


def test_a_client_may_publish_cbor_and_cdr(ros, roslib):
    found = []
    ros.node.create_subscription(Float64, "/float", found.append, 10)
    roslib.send_cbor("advertise", topic="/float", type="std_msgs/msg/Float64")
    roslib.send_cbor("publish", topic="/float", msg={"data": math.inf})
    roslib.send_cbor("publish", topic="/float", msg={"bytes": serialize_message(Float64(data=2.5))})
    ros.until(lambda: len(found) == 2)
    assert [each.data for each in found] == [math.inf, 2.5]
    roslib.send_cbor("publish", topic="/float", msg={"bytes": b"\0\1\0\0"}, id="p")
    assert roslib.next("status")["msg"].startswith("publish.msg: expected a Float64 in CDR: ")


def test_long_messages_come_in_fragments_and_go_in_fragments(ros, roslib, texts):
    roslib.send("subscribe", topic="/texts", fragment_size=100)
    _subscribed(ros, texts)
    texts.publish(String(data="x" * 300))
    parts = [roslib.next("fragment") for _ in range(4)]
    assert [(part["num"], part["total"]) for part in parts] == [(number, 4) for number in range(4)]
    assert json.loads("".join(part["data"] for part in parts))["msg"] == {"data": "x" * 300}
    found = []
    ros.node.create_subscription(String, "/back", found.append, 10)
    for part in parts:
        roslib.send("fragment", id="f", num=part["num"], total=4, data=part["data"].replace("/texts", "/back"))
    ros.until(lambda: found)
    assert found[0].data == "x" * 300


def test_a_throttled_subscription_with_a_queue_gets_its_messages_later(ros, roslib, texts):
    roslib.send("subscribe", topic="/texts", throttle_rate=30, queue_length=2)
    _subscribed(ros, texts)
    for text in "abcd":
        texts.publish(String(data=text))
    assert [roslib.next("publish")["msg"]["data"] for _ in range(3)] == ["a", "c", "d"]


def test_a_client_chooses_the_levels_of_statuses(roslib):
    roslib.send("set_level", level="none")
    roslib.send("unadvertise", topic="/a")
    roslib.call("/rosapi/nodes")
    assert roslib.received == []


def test_a_flood_of_one_client_does_not_delay_another(ros, bridge):
    port = bridge().port
    with RosClient(port, ros.until) as flooding, RosClient(port, ros.until) as other:
        flooding.send("advertise", topic="/flood", type="nav_msgs/Odometry")
        for _ in range(3000):
            flooding.send("publish", topic="/flood", msg={"pose": {"covariance": [0.0] * 36}})
        other.call("/rosapi/nodes")
        flooding.send("call_service", service="/rosapi/get_time", id="last")
        flooding.read()
        assert not flooding.received
        flooding.next("service_response", lambda answer: answer["id"] == "last")


def test_an_oversized_message_is_answered_and_the_connection_goes_on(ros, bridge):
    with RosClient(bridge(max_message_size=10_000).port, ros.until) as client:
        client.send("publish", topic="/a", msg={"data": "x" * 20_000})
        assert client.next("status")["msg"] == "frame: expected at most 10000 bytes (max_message_size), found 20053"
        version = client.call("/rosapi/get_ros_version")["values"]
        assert (version["version"], version["is_embedded"]) == (2, IS_EMBEDDED)
